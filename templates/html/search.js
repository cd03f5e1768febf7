"use strict";
// Search as you type, over data that come as a script: pages opened from a folder cannot fetch.
{
  const SHOWN = 20;
  const DATA = "search-data";
  // How much more a word counts in a name, and what counts for things of the device that the page is about.
  const NAME = 3;
  const HERE = 4;
  // Tiers of answers, the best first.
  const [EXACT, PART, WHOLE, RUN, BEGINS, WORDS] = [0, 1, 2, 3, 4, 5];

  // Index of the data

  const fold = (text) => (/^[\0-\x7f]*$/.test(text) ? text : text.normalize("NFKD").replace(/\p{M}/gu, "")).toLowerCase();
  // Beginnings are compared without what only marks a notation.
  const bare = (text) => fold(text).replace(/^(?:0x|c(?=\d)|i-|pnu )/, "");

  // Rows as objects, their numbers in a map, their words in one text with a line for each row or part.
  function prepare(data) {
    const numbers = new Map();
    const runs = [];
    const begins = [];
    const places = [];
    const index = (key, hit) => {
      const [, space, first, last, node] = /^(\w)(\d+)(?:-(\d+))?(?:@(\d+))?$/.exec(key);
      if (last) return runs.push({ space, first: Number(first), last: Number(last), node: node && Number(node), hit });
      const found = numbers.get(space + first);
      if (found) found.push(hit);
      else numbers.set(space + first, [hit]);
    };
    data.rows.forEach(([kind, device, name, words = "", spots = [], others = [], parts = []], order) => {
      const row = { order, kind, device, name, spots, parts: new Map(parts.map((it) => [it[0], it])) };
      for (const spot of [...spots, ...others]) {
        const hit = { row, spot };
        for (const key of spot[2] ? spot[2].split(" ") : []) index(key, hit);
        const short = bare(spot[0]);
        begins.push([short, short.replace(/^0+/, ""), fold(spot[0]), hit]);
      }
      const own = ` ${fold(name)} `;
      const numbered = spots.map((it) => fold(it[0])).join(" ");
      // What each LED of a row does, by its label.
      const [, ...seen] = kind === data.led[0] ? ` ${fold(words)} `.split(data.led[1]) : [];
      const lamps = seen.length ? new Map(seen.map((it) => [it.trim().split(" ")[0], it])) : null;
      places.push({ row, part: null, name: own, said: ` ${fold(words)} ${numbered} `, whole: "", lamps });
      for (const part of parts) {
        if (part[1]) places.push({ row, part, name: ` ${fold(part[1])} `, said: ` ${fold(part[2] ?? "")} `, whole: own });
      }
    });
    const starts = [];
    let at = 0;
    const lines = places.map((it) => `${it.name}\t${it.said}\t${it.whole}`);
    for (const line of lines) {
      starts.push(at);
      at += line.length + 1;
    }
    return { ...data, leds: new Set(data.leds), counts: new Set(data.counts), numbers, runs, begins, places, starts, text: lines.join("\n") };
  }

  // Answers

  function find(index, query, device) {
    const text = fold(query).replace(/=/g, " = ").trim().replace(/\s+/g, " ");
    if (!text) return { hits: [], instead: "" };
    const best = new Map();
    // One number for the order: tier, score, device of the page, place in the list.
    const add = (hit) => {
      const elsewhere = hit.row.device === device ? 0 : 1;
      hit.rank = ((hit.tier * 1000 - hit.score) * 2 + elsewhere) * 2 ** 31 + hit.row.order * 2 ** 10 + (hit.part ? hit.part[0] + 1 : 0);
      const key = hit.part ?? hit.row;
      const other = best.get(key);
      if (!other || hit.rank < other.rank) best.set(key, hit);
    };

    numbered(index, text, add);
    begun(index, text, add);
    const words = text.split(" ");
    const beside = lampsOf(index, words);
    worded(index, words, beside, device, add);
    const counted = flashes(index, words, beside);
    if (counted) worded(index, counted, beside, device, add);
    if (!best.size) unlisted(index, text, device, add);
    let instead = "";
    // Words of the trade, beside those that the manuals use.
    const called = Object.entries(index.also).reduce((it, [said, name]) => it.replace(` ${said} `, ` ${name} `), ` ${text} `).trim();
    if (called !== text) {
      if (!best.size) instead = called;
      const others = called.split(" ");
      worded(index, others, lampsOf(index, others), device, add);
    }
    if (!best.size) {
      const mended = words.map((word) => mend(index, word));
      if (mended.every(Boolean)) {
        instead = mended.join(" ");
        const others = instead.split(" ");
        worded(index, others, lampsOf(index, others), device, add);
      }
    }
    return { hits: [...best.values()].sort((a, b) => a.rank - b.rank), instead };
  }

  function numbered(index, text, add) {
    readings(text).forEach(({ spaces, number, parts }, nth) => {
      [...spaces].forEach((space, place) => {
        const score = -10 * nth - place;
        for (const hit of index.numbers.get(space + number) ?? []) exact(hit, parts, score, "", add);
        for (const run of index.runs) {
          if (run.space !== space || number < run.first || number > run.last) continue;
          const note = run.node === undefined ? "" : `of node ${number - run.first + run.node}`;
          add({ ...run.hit, tier: RUN, score, note });
        }
        if (space === "d") reported(index, number, score, add);
      });
    });
  }

  // A number that was found, or the part of it that was asked for; else what it is divided into comes after it.
  function exact(hit, parts, score, note, add) {
    const asked = parts.map((part) => hit.row.parts.get(part)).find(Boolean);
    if (asked) return add({ ...hit, part: asked, tier: EXACT, score, note });
    if (parts.length && !parts.includes(0)) return add({ ...hit, tier: WHOLE, score, note });
    add({ ...hit, tier: EXACT, score, note });
    if (!parts.length && hit.row.parts.size > 1) for (const part of hit.row.parts.values()) add({ ...hit, part, tier: PART, score, note });
  }

  // Error numbers as a drive reports them, with the fields that change at run time.
  function reported(index, number, score, add) {
    index.reported.forEach(([mask, drive], device) => {
      const listed = (number & mask) >>> 0;
      if (!mask || listed === number || number > 0xffffffff) return;
      const said = index.fields[drive].filter(([, , , , changes]) => changes).map((field) => read(field, number));
      const note = `reported with ${said.filter(Boolean).join(", ")}`;
      for (const hit of index.numbers.get(`d${listed}`) ?? []) {
        if (hit.row.device === device) add({ ...hit, tier: EXACT, score, note });
      }
      for (const { space, first, last, hit } of index.runs) {
        const holds = space === "d" && listed >= first && listed <= last;
        if (holds && hit.row.device === device) add({ ...hit, tier: RUN, score, note });
      }
    });
  }

  // What a field of an error number holds, "" for nothing; wide fields are written in hexadecimal.
  function read([label, low, high, names], number) {
    const value = Math.floor(number / 2 ** low) % 2 ** (high - low + 1);
    const shown = high - low < 8 ? value : `0x${value.toString(16)}`;
    return names[value] ? `${label} ${shown}: ${names[value]}` : value ? `${label} ${shown}` : "";
  }

  // An error number that no list has: its fields, and the way to the page that takes numbers apart.
  function unlisted(index, text, device, add) {
    const own = index.reported[device]?.[0] ? device : index.reported.findIndex(([mask]) => mask);
    const reading = readings(text).find(({ spaces, parts }) => spaces.includes("d") && !parts.length);
    if (own < 0 || !reading || reading.number < 2 ** 16 || reading.number >= 2 ** 32) return;
    const [, drive, page] = index.reported[own];
    const number = `0x${reading.number.toString(16).padStart(8, "0")}`;
    const said = index.fields[drive].map((field) => read(field, reading.number)).filter(Boolean).join(", ");
    const name = "In no list; its fields";
    const row = { order: 0, kind: index.kinds.length, device: own, name, spots: [], parts: new Map() };
    add({ row, spot: [number, `${page}?number=${number}#number`], tier: WORDS, score: 0, note: said });
  }

  // The LED that each word of a query stands beside, "" before the first.
  function lampsOf(index, words) {
    let led = "";
    return words.map((word) => (index.leds.has(word) ? (led = word) : led));
  }

  // The words with "blinks" as "flashes" where they say how often, null where they do not.
  function flashes(index, words, beside) {
    const counts = new Set(beside.filter((_, nth) => index.counts.has(words[nth]) || /^\dx?$/.test(words[nth])));
    const found = words.map((word, nth) => (counts.has(beside[nth]) && index.counted[word]) || word);
    return found.some((word, nth) => word !== words[nth]) ? found : null;
  }

  // Names that are written just so, and numbers that are still being typed.
  function begun(index, text, add) {
    const typed = /^(?:c|i-|0x|pnu )?[0-9a-f/]+h?$/.test(text) && /\d/.test(text);
    const start = bare(text).replace(/h$/, "");
    const plain = start === text;
    const inHex = text.startsWith("0x");
    for (const [short, digits, full, hit] of index.begins) {
      if (full === text) add({ ...hit, tier: WORDS, score: 4 * NAME, note: "" });
      if (!typed) continue;
      const fits = plain
        ? short.startsWith(start) || digits.startsWith(start)
        : full.startsWith(text) || (inHex && !full.startsWith("c") && short.startsWith(start));
      if (fits) add({ ...hit, tier: BEGINS, score: 0, note: "" });
    }
  }

  // Lines that hold every word, in whatever order; found by the longest, the rarest as a rule.
  function worded(index, words, beside, device, add) {
    const forms = words.map((word, nth) => [` ${word} `, ` ${word}`, word, beside[nth]]);
    const phrase = ` ${words.join(" ")}`;
    const rare = words.reduce((a, b) => (b.length > a.length ? b : a));
    let line = 0;
    for (let at = index.text.indexOf(rare); at >= 0; at = index.text.indexOf(rare, index.starts[line] ?? Infinity)) {
      line = lineAt(index.starts, at);
      const place = index.places[line];
      const score = rate(place, forms, phrase);
      // A whole comes before parts that say the same.
      const more = (place.row.device === device ? HERE : 0) - (place.part ? 1 : 0);
      if (score) add({ row: place.row, part: place.part, spot: null, tier: WORDS, score: score + more, note: "" });
      line += 1;
    }
  }

  function lineAt(starts, at) {
    let low = 0;
    let high = starts.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (starts[middle] <= at) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  // How well a line answers: whole words before beginnings before middles, the name before what is said of it.
  function rate({ name, said, whole, lamps }, forms, phrase) {
    if (lamps && forms.some((form) => ofAnother(lamps, form))) return 0;
    let score = 0;
    let own = !whole;
    for (const form of forms) {
      const ofName = weigh(name, form);
      const ofSaid = weigh(said, form);
      if (ofName || ofSaid) own = true;
      const best = Math.max(ofName * NAME, ofSaid * 2, whole && weigh(whole, form));
      if (!best) return 0;
      score += best;
    }
    if (!own) return 0;
    if (forms.length > 1) {
      if (name.includes(phrase) || said.includes(phrase)) score += 4 * forms.length;
      else if (forms.every(([, , word]) => word.length < 3)) return 0;
    }
    if (name === `${phrase} `) score += 2;
    return score;
  }

  // Whether another LED does what a word says of the one beside it.
  function ofAnother(lamps, [, beginning, , led]) {
    if (!lamps.has(led) || lamps.get(led).includes(beginning)) return false;
    return [...lamps.values()].some((it) => it.includes(beginning));
  }

  function weigh(text, [whole, beginning, middle]) {
    if (!text.includes(middle)) return 0;
    return text.includes(whole) ? 4 : text.includes(beginning) ? 3 : 1;
  }

  // The word of the data that one slip of typing turns into this one; the word itself where it occurs.
  function mend(index, word) {
    if (index.text.includes(word)) return word;
    if (word.length < 4) return "";
    index.vocabulary ??= [...new Set(index.text.match(/\p{L}{4,}/gu))];
    return index.vocabulary.find((other) => oneSlip(word, other)) ?? "";
  }

  function oneSlip(a, b) {
    if (Math.abs(a.length - b.length) > 1) return false;
    let head = 0;
    while (head < a.length && a[head] === b[head]) head += 1;
    const rests = [[1, 1], [1, 0], [0, 1]].map(([x, y]) => [a.slice(head + x), b.slice(head + y)]);
    const swapped = a[head] === b[head + 1] && a[head + 1] === b[head] && a.slice(head + 2) === b.slice(head + 2);
    return swapped || rests.some(([x, y]) => x === y);
  }

  // The field

  const make = (tag, attributes = {}, ...children) => {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children);
    return element;
  };

  const idle = window.requestIdleCallback ?? setTimeout;
  const home = document.getElementById("home-search");
  const place = home ?? document.getElementById("tools");
  if (place) mount(place);

  function mount(holder) {
    const field = make("input", {
      type: "search", id: "search", role: "combobox", "aria-autocomplete": "list", "aria-expanded": "false", "aria-controls": "answers",
      "aria-describedby": "search-keys", autocomplete: "off", autocapitalize: "none", spellcheck: "false", enterkeyhint: "go",
      placeholder: home ? "Code, index, error number, LED or words" : "Search",
    });
    const list = make("div", { role: "listbox", id: "answers", "aria-label": "Answers" });
    const foot = make("p", { class: "foot" });
    const panel = make("div", { class: "search-answers", hidden: "" }, list, foot);
    const status = make("p", { role: "status", class: "unseen" });
    const keys = make("kbd", { "aria-hidden": "true" }, "/");
    const box = make("div", { class: home ? "search large" : "search", role: "search" },
      make("label", { for: "search", class: "unseen" }, "Search codes, objects, errors, LEDs and everything else"),
      make("span", { id: "search-keys", class: "unseen" },
        "Slash focuses the field, the arrows choose an answer, Enter opens it, question mark shows all keys."),
      field, keys, panel, status);
    holder.prepend(box);

    let index = null;
    let asked = false;
    let hits = [];
    let active = -1;
    let moved = false;
    let device = -1;

    function load() {
      if (asked) return;
      asked = true;
      window.addEventListener(DATA, (event) => {
        index = prepare(event.detail);
        // The rarest way is also the slowest at its first use.
        idle(() => find(index, "zzzz", device));
        device = deviceOfPage(index.devices);
        if (field.value) answer();
      }, { once: true });
      document.head.append(make("script", { src: `${DATA}.js` }));
    }

    function answer() {
      if (!index) return;
      const start = performance.now();
      const result = find(index, field.value, device);
      performance.clearMeasures("search");
      performance.measure("search", { start });
      hits = result.hits.slice(0, SHOWN);
      moved = false;
      show(result);
    }

    function show({ hits: all, instead }) {
      const query = field.value.trim();
      list.replaceChildren(...hits.map((hit, nth) => option(index, hit, nth)));
      list.hidden = !hits.length;
      const count = all.length === 1 ? "1 answer" : `${all.length} answers`;
      foot.textContent = all.length
        ? (instead ? `Nothing found for “${query}”; these match “${instead}”. ` : "") +
          (all.length > SHOWN ? `The best ${SHOWN} of ${count}: type more to narrow them down.` : `${count}.`)
        : `Nothing found for “${query}”. You can search for codes, indexes, error, emergency and abort codes in ` +
          "hexadecimal or decimal, COB-IDs, LED patterns such as “red double flash”, and words of names; " +
          `for instance ${index.examples.join(", ")}.`;
      if (!query) return close();
      status.textContent = all.length ? foot.textContent : "Nothing found.";
      panel.hidden = false;
      field.setAttribute("aria-expanded", String(hits.length > 0));
      choose(hits.length ? 0 : -1);
    }

    function choose(nth) {
      list.children[active]?.removeAttribute("aria-selected");
      active = nth;
      const chosen = list.children[active];
      if (!chosen) return field.removeAttribute("aria-activedescendant");
      chosen.setAttribute("aria-selected", "true");
      field.setAttribute("aria-activedescendant", chosen.id);
      if (moved) chosen.scrollIntoView({ block: "nearest" });
    }

    function close() {
      panel.hidden = true;
      field.setAttribute("aria-expanded", "false");
      field.removeAttribute("aria-activedescendant");
      active = -1;
    }

    field.addEventListener("focus", load);
    field.addEventListener("input", answer);
    field.addEventListener("focus", () => index && field.value && panel.hidden && answer());
    field.addEventListener("keydown", (event) => {
      if (event.isComposing || event.altKey || event.metaKey) return;
      const open = !panel.hidden;
      const last = hits.length - 1;
      const steps = { ArrowDown: active < last ? active + 1 : 0, ArrowUp: active > 0 ? active - 1 : last, Home: 0, End: last };
      if (event.key === "Escape" && (open || field.value)) {
        if (!open) field.value = "";
        close();
        event.preventDefault();
      } else if (event.key === "Enter" && open && active >= 0) {
        event.preventDefault();
        list.children[active].click();
      } else if (event.key in steps && last >= 0 && !event.shiftKey) {
        // Home and End move in the text until the arrows have been used.
        if (event.key.length < 5 && !(open && moved)) return;
        event.preventDefault();
        if (!open) return answer();
        moved = true;
        choose(steps[event.key]);
      }
    });
    list.addEventListener("pointermove", (event) => {
      const over = event.target.closest("[role=option]");
      if (over) choose([...list.children].indexOf(over));
    });
    // An answer on this very page moves nothing but the view.
    list.addEventListener("click", () => setTimeout(() => {
      close();
      field.blur();
    }));
    box.addEventListener("focusout", (event) => { if (!box.contains(event.relatedTarget)) close(); });
    panel.addEventListener("pointerdown", (event) => { if (!event.target.closest("a")) event.preventDefault(); });

    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing || typing(event.target)) return;
      if (event.key === "/") {
        event.preventDefault();
        field.focus();
        field.select();
      } else if (event.key === "?") {
        event.preventDefault();
        help();
      }
    });
    if (home) idle(load);
  }

  const TYPING = "input:not([type=checkbox], [type=radio], [type=button]), textarea, select, dialog, [contenteditable]";
  const typing = (element) => element.closest?.(TYPING);

  // Pages of a device begin with its name.
  function deviceOfPage(devices) {
    const page = location.pathname.split("/").pop();
    return devices.findIndex(([id]) => page === `${id}.html` || page.startsWith(`${id}-`));
  }

  function option(index, { row, spot, part, note }, nth) {
    const spots = spot ? [spot] : row.spots;
    const text = spots.map((it) => (part ? `${it[0]}/${part[0]}` : it[0])).join(" / ");
    const address = part ? spots[0][3] + part[0] : spots[0][1];
    const name = part?.[1] ? [row.name, ": ", part[1]] : [row.name];
    const label = index.devices[row.device]?.[1];
    const kind = index.kinds[row.kind] ?? "Error number";
    return make("a", { role: "option", id: `answer-${nth}`, href: address, tabindex: "-1" },
      make("b", {}, text), " ", make("span", { class: "name" }, ...name, ...(note ? [" ", make("i", {}, note)] : [])), " ",
      make("small", {}, label ? `${label} · ${kind}` : kind));
  }

  // Keys

  let dialog = null;
  function help() {
    if (!dialog) {
      const rows = [
        ["/", "to the search field"], ["↓ ↑", "next and previous answer"], ["Home End", "first and last answer"],
        ["Enter", "open the answer"], ["Esc", "close the answers, then empty the field"], ["?", "this list"],
      ];
      const close = make("button", { type: "button" }, "Close");
      close.addEventListener("click", () => dialog.close());
      const heading = make("h2", { id: "keys-title" }, "Keys");
      const list = make("dl");
      for (const [keys, what] of rows) {
        const term = make("dt", {}, ...keys.split(" ").flatMap((it) => [make("kbd", {}, it), " "]));
        list.append(make("div", {}, term, make("dd", {}, what)));
      }
      dialog = make("dialog", { class: "keys", "aria-labelledby": "keys-title" }, heading, list, close);
      document.body.append(dialog);
    }
    dialog.showModal();
  }
}
