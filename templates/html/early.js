"use strict";
// Runs before the first paint: the theme that the reader chose, and the sign that scripts run.
document.documentElement.classList.replace("plain", "live");
try {
  const theme = localStorage.getItem("theme");
  if (theme) document.documentElement.dataset.theme = theme;
} catch {
  // Storage may be closed to pages that are opened from a folder.
}
