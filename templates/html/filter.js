"use strict";
// Narrows the overviews of a page to the rows that hold every word typed and every value chosen.
(() => {
  const box = document.querySelector(".filter");
  if (!box) return;
  const controls = [...box.querySelectorAll("input, select")];
  const status = box.querySelector("[role=status]");
  const clear = box.querySelector("button");
  const tables = [...document.querySelectorAll("main table.overview")];
  const sections = [...new Set(tables.map((table) => table.closest("section")))];

  // What is compared of a row: its text with that of the remarks below it and of its entry on this page, the numbers
  // that it covers, and its cells by their headings.
  const rows = tables.flatMap((table) => {
    const heads = [...table.tHead.rows[0].cells].map((cell) => cell.textContent.trim());
    const list = table.closest("section").querySelector("h2").textContent.trim();
    return [...table.tBodies[0].rows].filter((row) => !row.matches(".more")).map((row) => {
      const below = row.nextElementSibling?.matches(".more") ? [row.nextElementSibling] : [];
      const entry = document.getElementById(row.querySelector("a[href^='#']")?.hash.slice(1) ?? "");
      const elements = [row, ...below, ...(entry?.matches("article") ? [entry] : [])];
      const values = new Map(heads.map((head, place) => [head, row.cells[place].textContent.trim()]));
      values.set("", list);
      return { elements, values, text: [row.dataset.covers ?? "", ...elements.map((it) => it.textContent)].join(" ").toLowerCase() };
    });
  });

  const narrow = () => {
    const words = controls[0].value.toLowerCase().split(/\s+/).filter(Boolean);
    const choices = controls.slice(1).filter((select) => select.value);
    let shown = 0;
    for (const row of rows) {
      const fits =
        words.every((word) => row.text.includes(word)) &&
        choices.every((select) => row.values.get(select.dataset.column) === select.value);
      for (const element of row.elements) element.hidden = !fits;
      shown += fits;
    }
    for (const section of sections) section.hidden = shown > 0 && !section.querySelector(".overview tbody tr:not([hidden])");
    status.textContent = `${shown} of ${rows.length}`;
    clear.disabled = !words.length && !choices.length;
  };

  // The address holds what is chosen, so that it can be passed on.
  const remember = () => {
    const address = new URL(location.href);
    for (const { name, value } of controls) {
      if (value) address.searchParams.set(name, value);
      else address.searchParams.delete(name);
    }
    try {
      history.replaceState(null, "", address);
    } catch {
      // A browser may refuse it to pages that are opened from a folder.
    }
  };

  const chosen = new URLSearchParams(location.search);
  for (const control of controls) {
    control.value = chosen.get(control.name) ?? "";
    if (control.selectedIndex === -1) control.value = "";
    control.addEventListener("input", () => {
      narrow();
      remember();
    });
  }
  clear.addEventListener("click", () => {
    for (const control of controls) control.value = "";
    narrow();
    remember();
    controls[0].focus();
  });
  narrow();
})();
