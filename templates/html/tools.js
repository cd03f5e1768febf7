"use strict";
// Controls that every page gets: the switch of the theme, and buttons that copy what is often typed elsewhere.
{
  const status = document.createElement("p");
  status.className = "unseen";
  status.setAttribute("role", "status");
  document.body.append(status);
  const announce = (text) => { status.textContent = text; };

  // Theme

  const THEMES = ["system", "light", "dark"];
  const root = document.documentElement;
  const holder = document.getElementById("tools");
  if (holder) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "theme";
    const current = () => root.dataset.theme ?? THEMES[0];
    const name = () => {
      button.setAttribute("aria-label", `Theme: ${current()}`);
      button.title = `Theme: ${current()}`;
      button.dataset.shows = current();
    };
    button.addEventListener("click", () => {
      const next = THEMES[(THEMES.indexOf(current()) + 1) % THEMES.length];
      if (next === THEMES[0]) delete root.dataset.theme;
      else root.dataset.theme = next;
      try {
        if (next === THEMES[0]) localStorage.removeItem("theme");
        else localStorage.setItem("theme", next);
      } catch {
        // Not remembered where storage is closed.
      }
      name();
      announce(`Theme: ${next}`);
    });
    name();
    holder.append(button);
  }

  // Copying

  async function copy(text, button) {
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // The clipboard is closed to insecure pages; the old way still works there.
      const area = document.createElement("textarea");
      area.value = text;
      document.body.append(area);
      area.select();
      const done = document.execCommand("copy");
      area.remove();
      button.focus();
      if (!done) return announce(`Not copied: ${text}`);
    }
    announce(`Copied: ${text}`);
    button.dataset.done = "";
    setTimeout(() => delete button.dataset.done, 1500);
  }

  function copier(label, text, shown) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "copy";
    button.setAttribute("aria-label", `Copy ${label}: ${text}`);
    button.title = `Copy ${label}`;
    button.textContent = shown;
    button.addEventListener("click", () => copy(text, button));
    return button;
  }

  // Tables that are wider than their room can be scrolled with the keys; the others are no stop on the way.

  const named = (box) => {
    if (box.dataset.label) return box.dataset.label;
    const heading = box.closest("article, section")?.querySelector("h1, h2, h3, h4");
    return box.querySelector("caption")?.textContent ?? heading?.textContent.trim().replace(/\s+/g, " ") ?? document.title;
  };
  const wide = new ResizeObserver((entries) => {
    for (const box of new Set(entries.map(({ target }) => target.closest(".scroll")))) {
      if (box.scrollWidth > box.clientWidth) {
        box.tabIndex = 0;
        box.setAttribute("role", "group");
        box.setAttribute("aria-label", `${named(box)} (table)`);
      } else {
        for (const name of ["tabindex", "role", "aria-label"]) box.removeAttribute(name);
      }
    }
  });
  for (const box of document.querySelectorAll(".scroll")) {
    wide.observe(box);
    wide.observe(box.firstElementChild);
  }

  const addressOf = (href) => new URL(href, location.href).href;

  // An entry with a page of its own: its numbers and its address below the heading, its other numbers in their cells.
  const bar = document.querySelector(".copies");
  if (bar) {
    const numbers = [...bar.previousElementSibling.querySelectorAll(".no")];
    for (const it of numbers) bar.append(copier("number", it.textContent, it.textContent));
    bar.append(copier("link", addressOf(numbers[0].hash), "Link"));
    document.querySelectorAll(".variants tbody th").forEach((head, nth) => head.append(copier("link", addressOf(numbers[nth].hash), "")));
  }
  for (const cell of document.querySelectorAll(".variants tbody td")) {
    if (!cell.querySelector("a, cite") && /\d/.test(cell.textContent)) cell.append(copier("number", cell.textContent, ""));
  }
  for (const link of document.querySelectorAll(".subcodes tbody th a, .subindexes tbody th a")) {
    link.parentElement.append(copier("link", addressOf(link.hash), ""));
  }
  for (const name of document.querySelectorAll(".names code")) name.after(copier("name", name.textContent, ""));
  for (const bytes of document.querySelectorAll(".wire .bytes")) {
    const text = [...bytes.querySelectorAll("code")].map((code) => code.textContent).join(" ");
    bytes.previousElementSibling.append(copier("bytes", text, ""));
  }

  // Buttons that other scripts make say themselves what they copy.
  document.addEventListener("click", ({ target }) => {
    const button = target.closest("[data-copy]");
    if (button) copy(button.dataset.copy, button);
  });
}
