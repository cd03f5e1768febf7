"use strict";
// DIP switches to be set, and the finder of LED patterns. What they show comes from the data in the page.
(() => {
  // The state stands in the fragment ("#dip=group:positions,..."), apart from the anchors, which hold no "=".
  const kept = (name) => {
    const start = `#${name}=`;
    const text = location.hash.startsWith(start) ? location.hash.slice(start.length) : "";
    return new Map(text.split(",").filter(Boolean).map((pair) => pair.split(":")));
  };
  const keep = (name, pairs) => {
    const text = pairs.map((pair) => pair.join(":")).join(",");
    try {
      history.replaceState(null, "", text ? `#${name}=${text}` : location.pathname + location.search);
    } catch {
      // Browsers limit how often an address may change; the drawing is right without it.
    }
  };

  const bank = (element, { first, readings }, changed) => {
    const switches = [...element.querySelectorAll("[role=switch]")];
    const field = element.querySelector(".setting label > :is(input, select)");
    const wrong = element.querySelector(".wrong");
    const output = element.querySelector("output");
    const sentences = new Map(
      [...element.querySelectorAll("template")].map((it) => [it.dataset.case, it.content]),
    );
    // Values that can be asked for; of several positions of one value the first counts.
    const positionsOf = new Map();
    for (const [positions, [kind, value]] of Object.entries(readings)) {
      if (["number", "word", "sum"].includes(kind) && !positionsOf.has(value)) positionsOf.set(value, positions);
    }
    const positions = () => switches.map((it) => (it.getAttribute("aria-checked") === "true" ? "1" : "0")).join("");

    const tell = ([kind, value, anchor]) => {
      const sentence = sentences.get(kind).cloneNode(true);
      const figure = sentence.querySelector(".value");
      if (figure) {
        const link = figure.querySelector("a");
        (link ?? figure).textContent = value;
        link?.setAttribute("href", `#${anchor}`);
      }
      output.replaceChildren(sentence);
    };
    const set = (wanted) => {
      if (wanted === positions()) return;
      switches.forEach((it, place) => {
        it.setAttribute("aria-checked", String(wanted[place] === "1"));
        it.querySelector(".word").textContent = wanted[place] === "1" ? "ON" : "off";
      });
      tell(readings[wanted]);
    };
    const fill = () => {
      const [, value] = readings[positions()];
      field.value = positionsOf.has(value) ? value : "";
      field.removeAttribute("aria-invalid");
      wrong.textContent = "";
    };

    for (const [place, it] of switches.entries()) {
      it.disabled = false;
      it.addEventListener("click", () => {
        set([...positions()].map((sign, other) => (other === place ? "10"[sign] : sign)).join(""));
        fill();
        changed();
      });
    }
    field.addEventListener("input", () => {
      const value = field.value.trim();
      const wanted = positionsOf.get(value);
      const refused = wanted === undefined && (value !== "" || field.validity.badInput);
      if (refused) field.setAttribute("aria-invalid", "true");
      else field.removeAttribute("aria-invalid");
      wrong.textContent = refused ? "No such value; the switches stay as they are." : "";
      if (wanted === undefined) return;
      set(wanted);
      changed();
    });
    element.querySelector(".new")?.addEventListener("click", () => {
      set(first);
      fill();
      changed();
    });
    fill();
    return {
      id: element.dataset.group,
      positions,
      anchored: (anchor) => Object.keys(readings).find((it) => readings[it][2] === anchor),
      show: (wanted) => {
        if (!Object.hasOwn(readings, wanted)) return;
        set(wanted);
        fill();
      },
      isFirst: () => positions() === first,
    };
  };

  const boards = () => {
    const banks = [];
    const changed = () => keep("dip", banks.every((it) => it.isFirst()) ? [] : banks.map((it) => [it.id, it.positions()]));
    for (const board of document.querySelectorAll(".board")) {
      const data = JSON.parse(board.querySelector("script").textContent);
      for (const element of board.querySelectorAll(".bank")) {
        banks.push(bank(element, data[element.dataset.group], changed));
      }
    }
    // An address with switches sets them; so does that of a printed row.
    const restore = () => {
      const state = kept("dip");
      const anchor = location.hash.slice(1);
      for (const it of banks) it.show(state.get(it.id) ?? (anchor && it.anchored(anchor)));
    };
    addEventListener("hashchange", restore);
    restore();
  };

  const finder = (section) => {
    const rows = Object.entries(JSON.parse(section.querySelector("script").textContent)).map(([id, leds]) => ({
      leds,
      element: document.getElementById(id),
      state: document.querySelector(`.lamps a[href="#${CSS.escape(id)}"]`),
    }));
    const answers = section.querySelector(".answers");
    const fields = [...section.querySelectorAll("fieldset")];
    const status = section.querySelector("[role=status]");
    const overview = section.parentElement.querySelector(".overview")?.closest(".scroll");
    const tables = new Set(rows.map((row) => row.element.closest("article")));

    const chosen = () => fields.map((it) => it.querySelector(":checked")).filter((it) => it.value);
    const id = (radio) => radio.closest("fieldset").dataset.led;
    const named = (radio) =>
      `${radio.closest("fieldset").querySelector("b").textContent} ${radio.parentElement.textContent.trim()}`;

    const narrow = () => {
      const sights = chosen();
      const all = sights.length === 0;
      const spoken = new Set();
      answers.replaceChildren();
      let count = 0;
      for (const row of rows) {
        const asked = sights.filter((it) => id(it) in row.leds);
        const fits = all || (asked.length > 0 && asked.every((it) => row.leds[id(it)].includes(it.value)));
        row.element.hidden = !fits;
        if (!fits || all) continue;
        const answer = document.createElement("li");
        const meaning = row.state.closest("td").nextElementSibling.cloneNode(true);
        answer.append(row.state.cloneNode(true), ": ", ...meaning.childNodes);
        answers.append(answer);
        count += 1;
        for (const it of asked) spoken.add(it);
      }
      for (const table of tables) table.hidden = !table.querySelector("tbody tr:not([hidden])");
      if (overview) overview.hidden = !all;
      for (const field of fields) {
        field.querySelector("legend > span").className = field.querySelector(":checked").dataset.css;
      }
      const silent = sights.filter((it) => !spoken.has(it)).map(named).join(", ");
      const found = count ? `${count} of ${rows.length} rows fit.` : "Nothing fits.";
      status.textContent = all ? "" : found + (silent ? ` The manual has no row for ${silent}.` : "");
    };
    const choose = (state) => {
      for (const field of fields) {
        const radios = [...field.querySelectorAll("input")];
        (radios.find((it) => it.value === state.get(field.dataset.led)) ?? radios[0]).checked = true;
      }
      narrow();
    };

    section.addEventListener("change", () => {
      narrow();
      keep("see", chosen().map((it) => [id(it), it.value]));
    });
    section.querySelector("button").addEventListener("click", () => {
      choose(new Map());
      keep("see", []);
    });
    // An anchor wins over what was chosen where it would lead to a hidden row.
    const restore = () => {
      const target = document.getElementById(location.hash.slice(1));
      const state = kept("see");
      const buried = target?.closest("[hidden]");
      if (state.size || buried) choose(state);
      if (buried) target.scrollIntoView();
    };
    addEventListener("hashchange", restore);
    restore();
  };

  boards();
  for (const section of document.querySelectorAll(".finder")) finder(section);
})();
