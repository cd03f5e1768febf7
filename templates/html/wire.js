"use strict";
// Instruments for what travels on a bus: telegrams are built and decoded, error numbers and indexes taken apart.
// Every figure comes from the data of the page; this script knows layouts, services and notations, but no device.
(() => {
  const block = document.getElementById("wire-data");
  if (!block) return;
  const data = JSON.parse(block.textContent);

  // ---- Codec: bytes by a layout. Numbers are BigInt, texts strings, groups lists; null is left open.

  class Misfit extends Error {}
  const fail = (text) => { throw new Misfit(text); };

  const number = (name, scope) =>
    typeof scope[name] === "bigint" ? scope[name] : fail(`field '${name}' must be known to read what depends on it`);

  function length(field, scope) {
    if (field.sizes) {
      const by = number(field.sizes.by, scope);
      const size = field.sizes.of[by] ?? fail(`the length of field '${field.name}' is not known where '${field.sizes.by}' is ${by}`);
      const whole = size * (field.sizes.times ? Number(number(field.sizes.times, scope)) : 1);
      const to = field.sizes.fills;
      return to ? (to - (whole % to)) % to : whole;
    }
    return typeof field.length === "string" ? Number(number(field.length, scope)) : field.length;
  }

  const fromBytes = (bytes, big) => (big ? bytes : [...bytes].reverse()).reduce((sum, byte) => (sum << 8n) | BigInt(byte), 0n);

  function toBytes(value, size, big) {
    const bytes = Array.from({ length: size }, (_, place) => Number((value >> BigInt(8 * place)) & 0xffn));
    return big ? bytes.reverse() : bytes;
  }

  const hex = (bytes) => bytes.map((byte) => (byte === null ? "XX" : byte.toString(16).toUpperCase().padStart(2, "0"))).join(" ");
  const unhex = (text) => text.split(" ").filter(Boolean).map((pair) => parseInt(pair, 16));
  const characters = (bytes) => String.fromCharCode(...bytes);
  const codePoints = (text) => [...text].map((letter) => {
    const point = letter.codePointAt(0);
    return point < 256 ? point : fail(`'${letter}' is not in Latin-1`);
  });
  const constantOf = (field) => (field.constant ? BigInt(field.constant[0]) : undefined);

  // Fields with their values and the bytes that each takes; those of groups lie one after the other.
  function read(fields, bytes, start, outer, path, place) {
    const values = {};
    const spans = [];
    let position = start;
    for (const field of fields) {
      const scope = { ...outer, ...values };
      if (field.type === "group") {
        const count = field.count === null ? null : Number(number(field.count, scope));
        const found = [];
        while (count === null ? position < bytes.length : found.length < count) {
          const inner = read(field.fields, bytes, position, scope, `${path}${field.name}.`, `${place}${field.name}[${found.length + 1}].`);
          found.push(inner.values);
          spans.push(...inner.spans);
          position = inner.position;
        }
        values[field.name] = found;
        continue;
      }
      const size = length(field, scope);
      const end = size === null ? bytes.length : position + size;
      if (end > bytes.length) fail(`field '${field.name}' needs ${end - position} bytes, ${bytes.length - position} are left`);
      const value = readValue(field, bytes.slice(position, end));
      const constant = constantOf(field);
      if (constant !== undefined && value !== null && value !== constant) fail(`field '${field.name}' is ${value}, but must be ${constant}`);
      values[field.name] = value;
      for (const [low, high, label] of field.bits ?? []) {
        values[`${field.name}.${label}`] = typeof value === "bigint" ? slice(value, low, high) : null;
      }
      spans.push({ field, path: path + field.name, place: place + field.name, start: position, stop: end, values });
      position = end;
    }
    return { values, spans, position };
  }

  const slice = (value, low, high) => (value >> BigInt(low)) & ((1n << BigInt(high - low + 1)) - 1n);

  function readValue(field, bytes) {
    if (bytes.includes(null)) return null;
    if (field.type === "text") return characters(bytes);
    if (field.type === "bytes") return hex(bytes);
    const value = fromBytes(bytes, field.big);
    return field.type === "int" ? BigInt.asIntN(8 * bytes.length, value) : value;
  }

  function decode(layout, bytes) {
    const found = read(layout.fields, bytes, 0, {}, "", "");
    const left = bytes.length - found.position;
    if (left) fail(`${left} bytes are left over after field '${layout.fields.at(-1).name}'`);
    return found;
  }

  const encode = (layout, values) => write(layout.fields, values, { ...values });

  function write(fields, values, scope) {
    const bytes = [];
    for (const field of fields) {
      const value = values[field.name] ?? (field.name in values ? null : constantOf(field) ?? fail(`field '${field.name}' has no value`));
      scope[field.name] = value;
      if (field.type === "group") {
        if (!Array.isArray(value)) fail(`group '${field.name}' needs a list`);
        if (field.count !== null && Number(number(field.count, scope)) !== value.length) fail(`group '${field.name}' has ${value.length} entries, '${field.count}' says another number`);
        for (const entry of value) bytes.push(...write(field.fields, entry, { ...scope, ...entry }));
        continue;
      }
      const size = length(field, scope);
      const octets = writeValue(field, value, size);
      if (size !== null && octets.length !== size) fail(`field '${field.name}' has ${octets.length} bytes, its length is ${size}`);
      bytes.push(...octets);
    }
    return bytes;
  }

  function writeValue(field, value, size) {
    if (value === null) return Array.from({ length: size ?? 0 }, () => null);
    if (typeof value === "bigint") {
      const bits = 8 * (size ?? 0);
      const fits = field.type === "int" ? BigInt.asIntN(bits, value) === value : BigInt.asUintN(bits, value) === value;
      if (!fits) fail(`${value} does not fit the ${size} bytes of field '${field.name}'`);
      return toBytes(value, size ?? 0, field.big);
    }
    if (field.type === "text") return codePoints(value);
    if (field.type === "bytes") return unhex(value);
    return fail(`field '${field.name}' needs a number, not '${value}'`);
  }

  // ---- Services: a call (what a telegram is about) to bytes and back. A value is a BigInt or a list of bytes.

  const FILLER = /^\$([A-Z]+)(?: (\d+)\.\.\.(\d+)| ([a-z]\w*))?$/;
  const plain = (name) => name.replaceAll("_", "");

  // What a choice comes to for the data type of a call; anything else is what it is.
  function chosen(filling, call) {
    if (typeof filling !== "object" || filling === null || Array.isArray(filling)) return filling;
    const key = caseOf(filling, call) ?? ("else" in filling ? "else" : fail(`values of the type ${call.spelled || call.type} are not carried`));
    return chosen(filling[key], call);
  }

  function caseOf(choice, call) {
    const names = Object.keys(choice).filter((name) => name !== "else");
    const wanted = [call.spelled ?? "", call.type, String(width(call.type) / 8)];
    return wanted.map((name) => names.find((key) => plain(key) === plain(name))).find((key) => key !== undefined);
  }

  const width = (type) => data.types[type][0];
  const signed = (type) => Boolean(data.types[type][1]);
  const isNumber = (type) => width(type) > 0;
  const lowest = (type) => (signed(type) ? -(1n << BigInt(width(type) - 1)) : 0n);
  const highest = (type) => (1n << BigInt(width(type) - (signed(type) ? 1 : 0))) - 1n;

  const parse = (filling) => (typeof filling === "string" && filling.startsWith("$") ? FILLER.exec(filling) : null);

  function raw(value, type) {
    if (!isNumber(type)) fail(`${value} is a number, ${type} needs bytes`);
    if (value < lowest(type) || value > highest(type)) fail(`${value} does not fit ${type}`);
    return BigInt.asUintN(width(type), value);
  }

  function filled([, what, low, high], field, name, call) {
    let value;
    if (what === "INDEX") value = call.index;
    else if (what === "CODE") value = call.code;
    else if (what === "SUBINDEX") value = call.sub;
    else if (what === "ELEMENTS") value = call.sub == null ? null : call.sub > 0n ? 1n : 0n;
    else if (what === "ERROR") value = call.error;
    else if (what === "REGISTER") value = call.register;
    else if (what === "FREE") value = name in (call.free ?? {}) ? call.free[name] : call.unset === undefined ? 0n : call.unset;
    else if (what === "LENGTH") value = Array.isArray(call.value) ? BigInt(call.value.length) : width(call.type) ? BigInt(width(call.type) / 8) : call.length;
    else if (what === "BEHIND") value = 0n;
    else if (Array.isArray(call.value)) {
      if (field.type === "text") return characters(call.value);
      return field.type === "bytes" ? hex(call.value) : fromBytes(call.value, field.big);
    } else value = call.value == null ? null : raw(call.value, call.type);
    if (value === null || value === undefined) return null;
    return low === undefined ? value : slice(value, Number(low), Number(high));
  }

  function fill(fillings, fields, call) {
    const values = {};
    for (const field of fields) {
      const decided = (name) => {
        const filling = chosen(fillings[name], call);
        if (Array.isArray(filling)) return filling.map((entry) => fill(entry, field.fields, call));
        const filler = parse(filling);
        if (filler) return filled(filler, field, name, call);
        return typeof filling === "number" ? BigInt(filling) : filling;
      };
      const parts = (field.bits ?? []).map(([low, , label]) => [low, `${field.name}.${label}`]).filter(([, name]) => name in fillings);
      if (field.name in fillings) values[field.name] = decided(field.name);
      else if (parts.length) {
        const numbers = parts.map(([low, name]) => [low, decided(name)]);
        values[field.name] = numbers.some(([, part]) => part === null) ? null : numbers.reduce((sum, [low, part]) => sum + (part << BigInt(low)), 0n);
      } else if (!field.constant) values[field.name] = field.type === "text" || field.type === "bytes" ? "" : 0n;
    }
    return values;
  }

  // Fails where a service cannot hold values of the type of a call.
  function carried(service, call) {
    for (const message of [service.request, service.answer].filter(Boolean)) {
      for (const filling of [message.layout, ...Object.values(flat(message.values, "", {}))]) chosen(filling, call);
    }
  }

  const layoutOf = (message, call) => chosen(message.layout, call);

  function build(service, message, call) {
    const name = layoutOf(message, call);
    const layout = data.layouts[name];
    const values = fill(message.values, layout.fields, call);
    for (const [field, filling] of Object.entries(message.values)) {
      const filler = parse(filling);
      if (filler?.[1] !== "BEHIND") continue;
      const ahead = layout.fields.slice(0, layout.fields.findIndex((it) => it.name === filler[4]) + 1);
      values[field] = BigInt(encode(layout, values).length - encode({ fields: ahead }, values).length);
    }
    const bytes = encode(layout, values);
    if (service.limit !== null && bytes.length > service.limit) fail(`the telegram has ${bytes.length} bytes, at most ${service.limit} can be sent`);
    return { layout: name, bytes };
  }

  // What the fields of a telegram say, and whether it is just what the message would be; null where it cannot be it.
  function recognise(service, message, bytes, like) {
    try {
      const call = { ...like, index: null, code: null, sub: null, error: null, register: null, value: null, length: null, free: {} };
      const layout = data.layouts[layoutOf(message, like)];
      gather(message.values, layout.fields, decode(layout, bytes).values, like, call);
      if (typeof call.value === "bigint") call.value = signed(like.type) ? BigInt.asIntN(width(like.type), call.value) : call.value;
      const built = build(service, message, call).bytes;
      return built.length === bytes.length && built.every((byte, place) => byte === null || bytes[place] === null || byte === bytes[place]) ? call : null;
    } catch (error) {
      if (error instanceof Misfit) return null;
      throw error;
    }
  }

  const SLOTS = { INDEX: "index", CODE: "code", SUBINDEX: "sub", ERROR: "error", REGISTER: "register", VALUE: "value", LENGTH: "length" };

  function gather(fillings, fields, values, like, call) {
    for (const [name, filling] of Object.entries(fillings)) {
      const decided = chosen(filling, like);
      const field = fields.find((it) => it.name === name.split(".")[0]);
      if (Array.isArray(decided)) {
        decided.forEach((inner, place) => gather(inner, field.fields, values[name][place] ?? {}, like, call));
        continue;
      }
      const filler = parse(decided);
      if (!filler) continue;
      const [, what, low] = filler;
      let value = values[name] ?? null;
      if (typeof value === "string") {
        const bytes = field.type === "text" ? codePoints(value) : unhex(value);
        // Only a value can be a text; what else stands in bytes is a number.
        value = isNumber(like.type) || what !== "VALUE" ? fromBytes(bytes, field.big) : bytes;
      }
      if (what === "FREE") call.free[name] = value;
      else if (SLOTS[what] && value !== null) {
        call[SLOTS[what]] = low === undefined ? value : (call[SLOTS[what]] ?? 0n) | (value << BigInt(low));
      }
    }
  }

  // The test of the script calls these beside the controls.
  block.codec = { decode, encode, build, recognise, data };

  // ---- Notations: what people type.

  // A number, decimal or hexadecimal (0x1F, 1Fh, or digits that can be nothing else); null where it is none.
  function typed(text) {
    const found = /^(?:0x([0-9a-f]+)|\$?([0-9a-f]+)h|(-?\d+)|([0-9a-f]+))$/i.exec(text.replace(/[\s_]/g, ""));
    if (!found) return null;
    const digits = found[1] ?? found[2] ?? found[4];
    if (digits !== undefined) return BigInt(`0x${digits}`);
    return /^0\d/.test(found[3]) ? BigInt(`0x${found[3]}`) : BigInt(found[3]);
  }

  const inHex = (value, digits = 0) => `${value < 0n ? "-" : ""}0x${(value < 0n ? -value : value).toString(16).toUpperCase().padStart(digits, "0")}`;

  // A decimal number times a whole factor, exact; null where that is no whole number.
  function scaled(text, factor) {
    const found = /^([+-]?)(\d*)(?:[.,](\d+))?$/.exec(text.trim());
    if (!found || !(found[2] || found[3])) return null;
    const fraction = found[3] ?? "";
    const whole = BigInt(found[2] + fraction) * factor;
    const ten = 10n ** BigInt(fraction.length);
    return whole % ten ? null : (found[1] === "-" ? -1n : 1n) * (whole / ten);
  }

  // A whole number divided by a factor, as decimal digits; a fraction that has no end is left as one.
  function unscaled(value, factor) {
    let places = 0;
    while (places < 12 && (value * 10n ** BigInt(places)) % factor) places += 1;
    if ((value * 10n ** BigInt(places)) % factor) return `${value}/${factor}`;
    const digits = ((value < 0n ? -value : value) * 10n ** BigInt(places) / factor).toString().padStart(places + 1, "0");
    const cut = digits.length - places;
    return (value < 0n ? "-" : "") + digits.slice(0, cut) + (places ? `.${digits.slice(cut)}` : "");
  }

  const designation = (code) => `C${String(code).padStart(5, "0")}`;

  // ---- Page: elements, the address, messages.

  function make(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children.filter((child) => child !== null && child !== ""));
    return element;
  }

  const link = (href, text) => (href ? make("a", { href }, text) : text);
  const facts = (pairs) => make("dl", { class: "facts" }, ...pairs.filter((pair) => pair).map(([label, ...value]) => make("div", {}, make("dt", {}, label), make("dd", {}, ...value))));
  const sentence = (text) => text[0].toUpperCase() + text.slice(1) + (text.endsWith(".") ? "" : ".");
  const messages = (texts) => (texts.length ? make("ul", { class: "wrong" }, ...texts.map((text) => make("li", {}, sentence(text)))) : null);

  function copier(text, label) {
    return make("button", { type: "button", class: "copy", "data-copy": text, title: `Copy ${label}`, "aria-label": `Copy ${label}: ${text}` });
  }

  // The address holds what is chosen, so that a result can be sent; keys that are empty are left out.
  function remember(pairs) {
    const address = new URL(location.href);
    for (const [key, value] of Object.entries(pairs)) {
      if (value === "" || value === null) address.searchParams.delete(key);
      else address.searchParams.set(key, value);
    }
    try {
      history.replaceState(null, "", address);
    } catch {
      // A browser may refuse it to pages that are opened from a folder.
    }
  }

  const asked = () => new URLSearchParams(location.search);

  function instrument(id) {
    const section = document.getElementById(id);
    if (!section) return null;
    const form = section.querySelector(".controls");
    const result = section.querySelector("[data-shows=result]");
    result.setAttribute("aria-live", "polite");
    const fields = Object.fromEntries([...form.querySelectorAll("[name]")].map((control) => [control.name, control]));
    // What the page shows before anything is typed.
    const idle = [...result.children];
    const show = (...children) => result.replaceChildren(...children.filter((child) => child !== null));
    // What cannot be read leaves nothing of what stood there before.
    const guarded = (update) => (...given) => {
      try {
        update(...given);
      } catch (error) {
        show(messages([section.dataset.failed]));
        throw error;
      }
    };
    return { form, fields, idle, show, guarded };
  }

  // ---- Parameters of the page of telegrams.

  const ownOf = (parameter, sub) => parameter.subs?.find(([first, last]) => BigInt(first) <= sub && sub <= BigInt(last));
  const factsOf = (parameter, sub) => {
    const own = ownOf(parameter, sub);
    return own ? { ...parameter, ...own[3], subName: nameIn(own, Number(sub)) } : parameter;
  };
  // Numbers in braces count on with the number of the part.
  const nameIn = ([first, , name], sub) => name.replace(/\{(\d+)\}/g, (_, from) => String(Number(from) + sub - first));
  const partsOf = (parameter) => (parameter?.subs ?? []).flatMap((own) => Array.from({ length: own[1] - own[0] + 1 }, (_, nth) => [own[0] + nth, nameIn(own, own[0] + nth)]));
  const listOf = (about) => (about.list ? data.lists[about.list[0]] : []);
  const labelIn = (pairs, value) => pairs?.find(([number]) => BigInt(number) === value)?.[1];
  const parameterOf = (call) => data.parameters.find((it) => (call.code !== null && call.code !== undefined ? BigInt(it.code ?? -1) === call.code : BigInt(it.index) === call.index));

  // What a person names: a code, an object, or an index alone, as the search reads it; null where the text is neither.
  // What is known comes before what is likely; others: what else the text may mean, where that is not plain.
  function named(text) {
    const plainly = text.trim().replace(/^p-/i, "pnu-");
    const [first] = plainly.replace(/^pnu\s+/i, "pnu-").split(/\s/);
    const [whole, sub = ""] = first.split("/");
    const known = data.parameters.find((it) => it.key.toLowerCase() === whole.toLowerCase());
    if (known) return { ...address(known), known, part: sub ? typed(sub) : null, said: known.key, others: [] };
    const all = [plainly, first].map(meant).find((found) => found.length);
    if (!all) return null;
    const best = all.find((it) => it.known) ?? all[0];
    const plain = best.known && best === all[0];
    const part = best.parts.find((number) => best.known && ownOf(best.known, BigInt(number))) ?? best.parts[0];
    return { ...best, part: part === undefined ? null : BigInt(part), others: all.filter((it) => it !== best && (it.known || !plain)) };
  }

  // Every parameter that a text may mean.
  function meant(text) {
    const found = [];
    for (const { spaces, number, parts } of readings(text.toLowerCase()).filter((it) => Number.isSafeInteger(it.number))) {
      for (const space of spaces) {
        const place = space === "c" ? ofCode(BigInt(number)) : "ip".includes(space) ? ofIndex(BigInt(number)) : null;
        if (!place || place.index === null || place.index < 1n || place.index > highest("UNSIGNED16")) continue;
        const said = place.known?.key ?? (space === "c" ? designation(number) : `index ${inHex(place.index, 4)}`);
        if (!found.some((it) => it.index === place.index)) found.push({ ...place, parts, said });
      }
    }
    return found;
  }

  const address = (known) => ({ index: BigInt(known.index), code: known.code === undefined ? null : BigInt(known.code) });

  function ofCode(code) {
    if (data.base === null || code > BigInt(data.base)) return { index: null, code, known: parameterOf({ code }) };
    return { index: BigInt(data.base) - code, code, known: parameterOf({ code }) };
  }

  function ofIndex(index) {
    const known = parameterOf({ index });
    if (known) return { ...address(known), known };
    return { index, code: data.base !== null && index <= BigInt(data.base) ? BigInt(data.base) - index : null, known };
  }

  const unit = (about) => (about.unit ? ` ${about.unit}` : "");

  // A value in words: label, number in its unit, and how it travels where that is another number.
  function worded(value, about) {
    if (value === null || value === undefined) return "";
    if (Array.isArray(value)) return about.type === "OCTET_STRING" ? hex(value) : `“${characters(value)}”`;
    const factor = BigInt(about.scaling ?? 1);
    const label = labelIn(listOf(about), value);
    const shown = factor === 1n ? String(value) : unscaled(value, factor);
    const hexed = value > 9n && !label ? ` = ${inHex(value)}` : "";
    return `${shown}${unit(about)}${factor === 1n ? hexed : `, sent as ${value}`}${label ? `: ${label}` : ""}`;
  }

  // What speaks against a value of a parameter.
  function objections(value, about) {
    if (typeof value !== "bigint") return [];
    const found = [];
    const factor = BigInt(about.scaling ?? 1);
    const bound = (text) => (text === undefined ? null : scaled(text, factor));
    const [low, high] = [bound(about.low), bound(about.high)];
    if (low !== null && value < low) found.push(`The value is below the lower limit ${about.low}${unit(about)}.`);
    if (high !== null && value > high) found.push(`The value is above the upper limit ${about.high}${unit(about)}.`);
    const list = listOf(about);
    if (list.length && labelIn(list, value) === undefined) found.push("The value is not in the selection list.");
    return found;
  }

  // ---- Error numbers: found in the lists of the manual, shown with their parts.

  const masked = (kind, value) => (kind === "device" && data.mask !== undefined ? value & BigInt(data.mask) : value);
  const holds = ([kind, first, last], value) => value >= 0n && BigInt(first) <= masked(kind, value) && masked(kind, value) <= BigInt(last);
  const errorOf = ({ kind, error }) => data.errors.find((entry) => entry[0] === kind && holds(entry, error));
  const errorText = (kind, value) => `0x${value.toString(16).padStart(data.digits[kind], "0")}`;

  const errorParts = (value) => facts(data.fields.map(([name, low, high]) => {
    const part = slice(value, low, high);
    const label = data.values[name]?.[part];
    return [name[0].toUpperCase() + name.slice(1), `${part}${part > 9n ? ` = ${inHex(part)}` : ""}${label ? `: ${label}` : ""}`];
  }));

  function errorCard([kind, first, last, name, href, more], value) {
    const own = masked(kind, value);
    const place = Number(own - BigInt(first));
    const anchor = more.each && place ? `${href.split("#")[0]}#${more.each}${errorText(kind, own).slice(2)}` : href;
    const code = more.codes?.length === last - first + 1 ? more.codes[place] : null;
    const codes = code ? [code] : more.codes ?? [];
    return make("div", { class: "card" },
      make("p", {}, link(anchor, errorText(kind, own)), ` ${name}`),
      facts([
        ["List", data.kinds[kind]],
        more.slot ? ["Slot", more.slot] : null,
        last > first ? ["In the run", `${place + 1} of ${last - first + 1}`] : null,
        more.response ? ["Preset response", more.response] : null,
        codes.length ? ["Response set in", ...codes.flatMap(([text, target], nth) => [nth ? ", " : "", link(target, text)])] : null,
      ]));
  }

  // ---- Labelled bytes.

  function flat(fillings, path, into) {
    for (const [name, filling] of Object.entries(fillings)) {
      if (Array.isArray(filling)) for (const entry of filling) flat(entry, `${path}${name}.`, into);
      else into[path + name] = filling;
    }
    return into;
  }

  function meaning(span, match, about) {
    const value = span.values[span.field.name];
    if (value === null) return "open";
    const label = typeof value === "bigint" ? labelIn(span.field.values, value) : undefined;
    if (label) return label;
    if (span.field.errors) return value ? `${errorText(span.field.errors, value)} ${errorIn(span)?.[3] ?? "not in this manual"}` : "";
    const fillings = match ? flat(match.message.values, "", {}) : {};
    const filling = fillings[span.path];
    const decided = filling === undefined ? undefined : chosen(filling, match.call);
    const filler = parse(decided);
    if (filler) return spoken(filler, value, match.call, about);
    if (typeof filling === "object" && !/^\d+$/.test(caseOf(filling, match.call) ?? "0") && value) return caseOf(filling, match.call);
    if (span.field.bits && typeof value === "bigint") {
      return span.field.bits
        .map(([, , part]) => [part, span.values[`${span.field.name}.${part}`]])
        .filter(([part, bits]) => bits || (match ? `${span.field.name}.${part}` in fillings : labelIn(span.field.parts?.[part], bits)))
        .map(([part, bits]) => labelIn(span.field.parts?.[part], bits) ?? `${part} ${bits}`)
        .join(", ");
    }
    if (typeof value === "string") return span.field.type === "text" && value ? `“${value}”` : "";
    return span.field.constant ? "" : value > 9n ? `${value}` : "";
  }

  function spoken([, what, low, , field], value, call, about) {
    if (what === "BEHIND") return `${value} bytes behind ${field}`;
    if (what === "ELEMENTS") return value ? "" : "no subindex";
    if (what === "CODE") return designation(value);
    if (what === "VALUE") return low === undefined || low === "0" ? worded(call.value, about) : "";
    if (what === "FREE") return call.asks ? "free to choose" : "";
    if (what === "ERROR") return low === undefined ? errorOf(call)?.[3] ?? "" : inHex(value);
    return typeof value === "bigint" ? String(value) : "";
  }

  function strip(spans, bytes, match, about) {
    return make("ol", { class: "bytes" }, ...spans.filter((span) => span.start < span.stop).map((span) => {
      const text = meaning(span, match, about);
      return make("li", {}, make("code", {}, hex(bytes.slice(span.start, span.stop))), " ", make("b", {}, span.field.title), text ? " " : "", text ? make("small", {}, text) : "");
    }));
  }


  const errorIn = ({ field, values }) => errorOf({ kind: field.errors, error: values[field.name] });

  // Error numbers that stand in fields of their own, as the decoder of error numbers shows them.
  const errorsIn = (spans) => spans.filter((span) => span.field.errors && span.values[span.field.name]).flatMap((span) => {
    const value = span.values[span.field.name];
    const entry = errorIn(span);
    return [span.field.errors === "device" && data.fields ? errorParts(value) : null, entry ? errorCard(entry, value) : null];
  });

  function parameterLink(call) {
    const parameter = parameterOf(call);
    const sub = call.sub ? `/${call.sub}` : "";
    if (parameter) {
      const about = factsOf(parameter, call.sub ?? 0n);
      return [link(parameter.href, `${parameter.key}${sub}`), ` ${parameter.name}${about.subName ? `: ${about.subName}` : ""}`];
    }
    const code = call.code ?? (data.base !== null && call.index <= BigInt(data.base) ? BigInt(data.base) - call.index : null);
    const names = [code === null ? "" : designation(code) + sub, call.index === null ? "" : `index ${inHex(call.index, 4)}${sub}`];
    return [`${names.filter(Boolean).join(", ")}, not in this manual`];
  }

  // ---- Builder.

  function startBuilder() {
    const it = instrument("builder");
    if (!it) return;
    const { form, fields, show, guarded } = it;
    const state = asked();
    const free = form.querySelector(".free");
    const note = (id, text) => { document.getElementById(id).textContent = text; };
    let about = {};
    let shown = "";

    document.getElementById("b-codes").append(...data.parameters.map((one) => make("option", { value: `${one.key} ${one.name}` })));
    if (fields.node) fields.node.value = state.get("node") ?? (data.node === null ? "" : String(data.node));
    if (state.has("code")) fields.code.value = state.get("code");
    if (state.has("service")) fields.service.value = state.get("service");
    if (fields.service.selectedIndex < 0) fields.service.selectedIndex = 0;

    const service = () => data.services.find((one) => one.id === fields.service.value);
    const target = () => named(fields.code.value);

    // What is chosen decides which controls there are and what they hold to begin with.
    function changeTarget(keep) {
      const place = target();
      const sub = place?.part ?? (keep ? typed(fields.sub.value) : null);
      const subs = partsOf(place?.known);
      const first = subs.find(([number]) => number > 0)?.[0] ?? subs[0]?.[0] ?? 0;
      fields.sub.value = String(sub ?? first);
      document.getElementById("b-subs").replaceChildren(...subs.map(([number, name]) => make("option", { value: String(number), label: name })));
      shown = "";
    }

    const reveal = (control, shows) => { control.parentElement.hidden = !shows; };

    function changeFacts() {
      const place = target();
      const sub = typed(fields.sub.value) ?? 0n;
      about = place?.known ? factsOf(place.known, sub) : {};
      const key = `${place?.index}/${sub}`;
      const known = about.type !== undefined;
      const writes = service().does === "write";
      const list = listOf(about);
      reveal(fields.type, !known);
      reveal(fields.scaling, !known && writes);
      reveal(fields.value, writes);
      reveal(fields.option, writes && list.length > 0);
      document.getElementById("b-limits").hidden = !writes;
      if (known) {
        fields.type.value = about.type;
        fields.scaling.value = String(about.scaling ?? 1);
      }
      if (key !== shown) {
        shown = key;
        fields.option.replaceChildren(make("option", { value: "" }, "another value"), ...list.map(([value, label]) => make("option", { value: String(value) }, `${value}: ${label}`)));
        fields.value.value = initial();
      }
      const read = place?.others.length ? ` Read as ${place.said}; it could also be ${place.others.map((it) => it.said).join(" or ")}.` : "";
      note("b-known", known && place ? `${about.key}${sub ? `/${sub}` : ""} ${about.name}${about.subName ? `: ${about.subName}` : ""}; ${about.spelled ?? about.type}, index ${place.index} = ${inHex(place.index, 4)}${read && `.${read}`}` : place ? `Index ${place.index} = ${inHex(place.index, 4)}; not in this manual, so choose its data type and scaling.${read}` : "");
      note("b-limits", about.low === undefined ? "" : `From ${about.low} to ${about.high}${unit(about)}.`);
      form.querySelector("[data-shows=unit]").textContent = about.unit ? `in ${about.unit}` : "";
    }

    function initial() {
      if (about.signature) return about.signature;
      if (!about.default) return about.low ?? (listOf(about).length ? String(listOf(about)[0][0]) : "0");
      const [value, rule] = about.default;
      if (rule) return String(BigInt(value) + (typed(fields.node?.value ?? "") ?? 0n));
      return typeof value === "string" ? value : unscaled(BigInt(value), BigInt(about.scaling ?? 1));
    }

    // Controls for what the sender may choose.
    function changeService() {
      const layout = data.layouts[firstLayout(service().request)];
      const open = Object.entries(service().request.values).filter(([, filling]) => parse(filling)?.[1] === "FREE").map(([name]) => name);
      const inputs = [...free.querySelectorAll("input")];
      if (inputs.map((input) => input.name).join() === open.join()) return;
      const before = Object.fromEntries(inputs.map((input) => [input.name, input.value]));
      free.replaceChildren(free.firstElementChild, ...open.map((name) => {
        const [whole, part] = name.split(".");
        const title = part ?? layout.fields.find((field) => field.name === whole).title;
        const input = make("input", { id: `b-${name}`, name, value: before[name] ?? "0", autocomplete: "off", inputmode: "numeric", spellcheck: "false" });
        return make("p", { class: "narrow" }, make("label", { for: `b-${name}` }, title), " ", input);
      }));
      free.hidden = !open.length;
    }

    const firstLayout = (message) => (typeof message.layout === "string" ? message.layout : Object.values(message.layout)[0]);

    function valueToSend() {
      const type = fields.type.value;
      const text = fields.value.value;
      if (about.signature && text === about.signature) return codePoints(text);
      if (type === "OCTET_STRING") return unhex(text.replace(/0x|[^0-9a-f]/gi, "").replace(/..?/g, "$& "));
      if (!isNumber(type)) return codePoints(text);
      const factor = typed(fields.scaling.value) ?? 0n;
      if (factor < 1n) fail("The scaling is a whole number above 0.");
      if (/^\s*(?:0x[0-9a-f]+|[0-9a-f]+h)\s*$/i.test(text)) {
        const value = typed(text);
        return signed(type) && value <= BigInt.asUintN(width(type), -1n) ? BigInt.asIntN(width(type), value) : value;
      }
      return scaled(text, factor) ?? fail(factor === 1n ? `'${text}' is not a whole number.` : `'${text}' times ${factor} is not a whole number.`);
    }

    const update = guarded(() => {
      changeFacts();
      changeService();
      const place = target();
      const chosenService = service();
      const writes = chosenService.does === "write";
      const wrong = [];
      let telegram = null;
      let call = {};
      try {
        const sub = typed(fields.sub.value);
        const node = fields.node?.value.trim() ?? "";
        if (node && !isNode(typed(node))) fail(`'${node}' is no node address: they go from ${data.nodes.join(" to ")}.`);
        if (!place) fail("Name a code, an object or an index; the field lists those that are known.");
        if (sub === null || sub < 0n) fail("The subcode is a number, 0 where there is none.");
        const chosenFree = {};
        for (const input of free.querySelectorAll("input")) chosenFree[input.name] = typed(input.value) ?? fail(`'${input.value}' is not a number.`);
        call = { type: fields.type.value, spelled: about.spelled, index: place.index, code: place.code, sub, free: chosenFree, asks: true, value: null };
        if (writes) call.value = valueToSend();
        if (place.code === null && JSON.stringify(chosenService.request.values).includes("$CODE")) fail("This bus reads and writes codes by their number; the index stands for none.");
        carried(chosenService, call);
        telegram = build(chosenService, chosenService.request, call);
        wrong.push(...remarks(place, sub, call, writes));
      } catch (error) {
        if (!(error instanceof Misfit)) throw error;
        wrong.push(error.message);
        telegram = null;
      }
      if (writes) fields.option.value = typeof call.value === "bigint" && labelIn(listOf(about), call.value) !== undefined ? String(call.value) : "";
      show(...(telegram ? picture(chosenService, telegram, call) : []), messages(wrong));
    });

    function remarks(place, sub, call, writes) {
      const found = [];
      const known = place.known;
      if (known?.subs && !ownOf(known, sub)) found.push(`${known.key} has no ${known.reached === "codes" ? "subcode" : "sub-index"} ${sub}.`);
      if (known && !known.subs && sub > 0n) found.push(`${known.key} has no subcodes.`);
      if (known && !service().reaches.includes(known.reached)) found.push(`${service().name} does not reach ${known.key}.`);
      if (about.access !== undefined && !about.access.includes(writes ? "w" : "r")) found.push(`${about.key} cannot be ${writes ? "written" : "read"}.`);
      return writes ? [...found, ...objections(call.value, about)] : found;
    }

    function picture(chosenService, telegram, call) {
      const layout = data.layouts[telegram.layout];
      const text = hex(telegram.bytes);
      const identifier = chosenService.request.identifier;
      const node = fields.node ? typed(fields.node.value) : null;
      const base = identifier ? BigInt(connectionNamed(identifier).base) : null;
      const number = base === null ? null : node === null ? `${inHex(base, 3)} + node address` : inHex(base + node, 3);
      return [
        facts([number === null ? null : ["Identifier", make("code", { class: "identifier" }, number)], ["Bytes", make("code", { class: "telegram-bytes" }, text), copier(text, "bytes")]]),
        strip(decode(layout, telegram.bytes).spans, telegram.bytes, { message: chosenService.request, call }, about.type ? about : { type: call.type, scaling: fields.scaling.value }),
      ];
    }

    function keep() {
      const writes = service().does === "write";
      const known = about.type !== undefined;
      const sub = typed(fields.sub.value);
      const place = target();
      const code = place?.known?.key ?? place?.said.replace(/^index /, "") ?? fields.code.value.trim();
      remember({
        service: fields.service.value,
        code: `${code.split("/")[0]}${sub ? `/${sub}` : ""}`,
        value: writes ? fields.value.value : "",
        type: known ? "" : fields.type.value,
        scaling: known || fields.scaling.value === "1" ? "" : fields.scaling.value,
        node: fields.node?.value ?? "",
        raw: "",
        ...Object.fromEntries([...free.querySelectorAll("input")].map((input) => [input.name, input.value === "0" ? "" : input.value])),
      });
    }

    form.addEventListener("input", (event) => {
      if (event.target === fields.code) changeTarget(false);
      if (event.target === fields.option && fields.option.value) fields.value.value = unscaled(BigInt(fields.option.value), BigInt(about.scaling ?? 1));
      update();
      keep();
    });
    changeTarget(false);
    changeFacts();
    if (state.has("type") && about.type === undefined) fields.type.value = state.get("type");
    if (state.has("scaling") && about.type === undefined) fields.scaling.value = state.get("scaling");
    const raws = typed(state.get("raw") ?? "");
    if (raws !== null) fields.value.value = unscaled(raws, BigInt(about.scaling ?? 1));
    if (state.has("value")) fields.value.value = state.get("value");
    changeService();
    for (const input of free.querySelectorAll("input")) input.value = state.get(input.name) ?? input.value;
    update();
  }

  // ---- Decoder.

  // Bytes as people paste them, with the identifier where a log puts it in front; null where they are none.
  function pasted(text) {
    const logged = /^\s*(?:\([\d.]+\)\s*)?(?:\w*can\d+\s+)?([0-9a-f]{3,8})\s*(?:#|\[\d+\])\s*(.*)$/i.exec(text);
    const body = (logged ? logged[2] : text).replace(/0x/gi, " ").replace(/h\b/gi, " ");
    const tokens = body.split(/[\s,;:.-]+/).filter(Boolean);
    if (!tokens.every((token) => /^(?:[0-9a-f]|x|\?)+$/i.test(token) && (token.length < 3 || token.length % 2 === 0))) return null;
    const pairs = tokens.flatMap((token) => (token.length < 3 ? [token] : token.match(/../g)));
    return { identifier: logged ? BigInt(`0x${logged[1]}`) : null, bytes: pairs.map((pair) => (/[x?]/i.test(pair) ? null : parseInt(pair, 16))) };
  }

  // What an identifier is in the predefined connection set, with the node; null where it is nothing there.
  function connectionOf(identifier) {
    for (const connection of data.connections) {
      const node = identifier - BigInt(connection.base);
      if (connection.broadcast ? node === 0n : isNode(node)) return { ...connection, node: connection.broadcast ? null : node };
    }
    return null;
  }

  const connectionNamed = (name) => data.connections.find((it) => it.name === name);
  const isNode = (number) => number !== null && BigInt(data.nodes[0]) <= number && number <= BigInt(data.nodes[1]);

  // Every message of a service that the bytes may be, the one with the data type of the parameter first.
  // name: the layout; connection: what the identifier is, null without; strict: messages of other identifiers do not count.
  function matches(name, bytes, connection, strict) {
    const found = [];
    for (const service of data.services) {
      for (const role of ["request", "answer"]) {
        const message = service[role];
        if (!message) continue;
        const reached = message.identifier === null || connection === null || message.identifier === connection.name;
        if (strict && !reached) continue;
        for (const type of Object.keys(data.types)) {
          const call = possible(service, message, name, bytes, type);
          if (!call) continue;
          call.kind = service.errors;
          found.push({ service, message, role, call, rank: (reached ? 4 : 0) + (role === "request" ? 1 : 0) + likelihood(call) });
        }
      }
    }
    return found.sort((a, b) => b.rank - a.rank);
  }

  // Numbers that the manual knows speak for a message, those that it does not know against it.
  function likelihood(call) {
    if (call.kind && call.error !== null) return errorOf(call) ? 3 : -3;
    const parameter = parameterOf(call);
    const type = parameter ? factsOf(parameter, call.sub ?? 0n).type : undefined;
    if (type !== undefined) return type === call.type ? 5 : 3;
    return isNumber(call.type) && !signed(call.type) ? 1 : 0;
  }

  function possible(service, message, name, bytes, type) {
    const like = { type };
    try {
      if (layoutOf(message, like) !== name) return null;
    } catch (error) {
      if (error instanceof Misfit) return null;
      throw error;
    }
    return recognise(service, message, bytes, like);
  }

  // How well bytes fit a layout: what a service would send counts most, then constants and values with a meaning.
  function fits(name, bytes, connection, strict) {
    const layout = data.layouts[name];
    let spans;
    try {
      spans = decode(layout, bytes).spans;
    } catch (error) {
      if (error instanceof Misfit) return { name, error: error.message };
      throw error;
    }
    const match = matches(name, bytes, connection, strict)[0] ?? null;
    let rank = match ? 100 + 10 * match.rank : 0;
    for (const { field, values } of spans) {
      const value = values[field.name];
      if (field.constant) rank += 1;
      if (field.length === null && !field.sizes) rank -= 2;
      if (typeof value !== "bigint") continue;
      if (field.values) rank += labelIn(field.values, value) === undefined ? -1 : 3;
      else for (const [part, list] of Object.entries(field.parts ?? {})) rank += labelIn(list, values[`${field.name}.${part}`]) === undefined ? -1 : 3;
    }
    return { name, spans, match, rank };
  }

  function startDecoder() {
    const it = instrument("decoder");
    if (!it) return;
    const { form, fields, idle, show, guarded } = it;
    const state = asked();
    fields.bytes.value = state.get("bytes") ?? "";
    if (fields.id) fields.id.value = state.get("id") ?? "";
    fields.layout.value = state.get("layout") ?? "";
    if (fields.layout.selectedIndex < 0) fields.layout.value = "";

    const update = guarded(() => {
      if (!fields.bytes.value.trim()) return show(...idle);
      const found = pasted(fields.bytes.value);
      if (!found || (!found.bytes.length && found.identifier === null)) return show(messages(["These are not bytes in hexadecimal: two digits each."]));
      const text = fields.id?.value.trim().replace(/^0x|h$/gi, "") ?? "";
      if (text && !/^[0-9a-f]+$/i.test(text)) return show(messages([`'${fields.id.value}' is not a hexadecimal identifier.`]));
      // Buses without identifiers have none to go by.
      const given = text ? BigInt(`0x${text}`) : found.identifier;
      const identifier = data.connections.length ? given : null;
      const connection = identifier === null ? null : connectionOf(identifier);
      const forced = fields.layout.value;
      const names = forced ? [forced] : layoutsFor(identifier, connection);
      const all = names.map((name) => fits(name, found.bytes, connection, !forced));
      const good = all.filter((one) => !one.error).sort((a, b) => b.rank - a.rank);
      if (good.length) return show(...picture(good[0], found.bytes, identifier, connection), others(good.slice(1)));
      if (forced) return show(messages(all.map((one) => `Does not fit the layout: ${one.error}`)));
      if (connection) return show(...unread(found.bytes, identifier, connection));
      show(messages([...strange(identifier, connection), `No telegram of this device has ${found.bytes.length} bytes like these.`]));
    });

    // The identifier decides which telegrams there can be; values of objects are none.
    function layoutsFor(identifier, connection) {
      if (identifier === null) return Object.keys(data.layouts);
      return connection?.layouts ?? [...new Set(data.connections.flatMap((it) => it.layouts))];
    }

    const strange = (identifier, connection) => (identifier !== null && !connection ? [`The identifier ${inHex(identifier, 3)} is not in the predefined connection set.`] : []);

    // What the identifier alone says.
    const identified = (identifier, connection) => (connection ? [
      ["Identifier", `${inHex(identifier, 3)} = ${connection.name}: ${connection.title}`],
      connection.node === null ? null : ["Node address", String(connection.node)],
    ] : []);

    // A telegram of which nothing but the identifier is known.
    function unread(bytes, identifier, connection) {
      return [
        make("p", { class: "found" }, connection.name),
        facts(identified(identifier, connection)),
        bytes.length ? make("ol", { class: "bytes" }, make("li", {}, make("code", {}, hex(bytes)), " ", make("b", {}, connection.title))) : null,
        messages(connection.layouts.length ? [`No telegram of ${connection.name} has ${bytes.length} bytes like these.`] : []),
      ];
    }

    function picture({ name, spans, match }, bytes, identifier, connection) {
      const layout = data.layouts[name];
      const call = match?.call ?? null;
      const parameter = call && (call.index !== null || call.code !== null) ? parameterOf(call) : null;
      const about = { type: call?.type, ...(parameter ? factsOf(parameter, call.sub ?? 0n) : {}) };
      const error = call?.error != null ? errorOf(call) : null;
      const title = match ? [link(match.service.href, match.service.name), match.role === "request" ? ", request" : match.service.request ? ", answer" : ""] : [link(layout.href, layout.name)];
      return [
        make("p", { class: "found" }, ...title),
        facts([
          ...identified(identifier, connection),
          call && (call.index !== null || call.code !== null) ? ["Parameter", ...parameterLink(call)] : null,
          call && call.value !== null ? ["Value", worded(call.value, about)] : null,
          call?.error != null ? ["Error", ...(error ? [link(error[4], errorText(call.kind, call.error)), ` ${error[3]}`] : [`${errorText(call.kind, call.error)}, not in this manual`])] : null,
          ["Layout", link(layout.href, name)],
        ]),
        strip(spans, bytes, match, about),
        ...errorsIn(spans),
        messages([...strange(identifier, connection), ...contradictions(name, match, about, identifier, connection)]),
      ];
    }

    function* contradictions(name, match, about, identifier, connection) {
      if (!match) {
        if (connection && !connection.layouts.includes(name)) yield `The identifier ${inHex(identifier, 3)} is that of ${connection.name}, which has no telegrams of this layout.`;
        const sent = data.services.some((service) => [service.request, service.answer].some((message) => message && layouts(message).includes(name)));
        if (sent && (connection || fields.layout.value)) yield "No service of this device sends just these bytes; look at the fields.";
        return;
      }
      const { call, service, role, message } = match;
      if (connection && message.identifier !== null && message.identifier !== connection.name) {
        yield `The identifier ${inHex(identifier, 3)} is not one of ${message.identifier} (${inHex(BigInt(connectionNamed(message.identifier).base), 3)} + node address).`;
      }
      if (call.value !== null && about.key && call.type !== about.type) {
        yield `${about.key} is ${about.spelled ?? about.type}; the telegram carries a value like ${call.type}.`;
      }
      if (about.subs && !ownOf(about, call.sub)) yield `${about.key} has no ${about.reached === "codes" ? "subcode" : "sub-index"} ${call.sub}.`;
      if (about.key && !about.subs && call.sub > 0n) yield `${about.key} has no subcodes.`;
      const letter = { read: "r", write: "w" }[service.does];
      if (letter && role === "request" && about.access !== undefined && !about.access.includes(letter)) yield `${about.key} cannot be ${letter === "w" ? "written" : "read"}.`;
      yield* objections(call.value, about);
    }

    const layouts = (message) => (typeof message.layout === "string" ? [message.layout] : Object.values(message.layout));

    function others(rest) {
      if (!rest.length) return null;
      const buttons = rest.map(({ name }) => {
        const button = make("button", { type: "button" }, data.layouts[name].name);
        button.addEventListener("click", () => {
          fields.layout.value = name;
          fields.layout.focus();
          update();
          keep();
        });
        return button;
      });
      return make("p", { class: "others" }, "Could also be: ", ...buttons);
    }

    const keep = () => remember({ bytes: fields.bytes.value.trim(), id: fields.id?.value.trim() ?? "", layout: fields.layout.value });
    form.addEventListener("input", () => {
      update();
      keep();
    });
    update();
  }

  // ---- Error numbers.

  function startErrors() {
    const it = instrument("number");
    if (!it) return;
    const { form, fields, idle, show, guarded } = it;
    const found = (value) => data.errors.filter((entry) => holds(entry, value));
    const longest = Math.max(...Object.values(data.digits));

    const update = guarded(() => {
      const text = fields.number.value.trim();
      if (!text) return show(...idle);
      const value = typed(text);
      if (value === null || value < 0n) return show(messages([`'${text}' is not a number.`]));
      if (value >> BigInt(4 * longest)) return show(messages([`'${text}' is too long: error numbers have at most ${longest} hexadecimal digits.`]));
      const entries = found(value);
      const otherwise = /^\d+$/.test(text) && BigInt(`0x${text}`) !== value ? BigInt(`0x${text}`) : null;
      const second = otherwise !== null && !entries.length ? found(otherwise) : [];
      const meant = second.length ? otherwise : value;
      const shown = second.length ? second : entries;
      show(
        make("p", { class: "found" }, make("code", {}, inHex(meant, meant > 0xffffn ? 8 : 4)), ` = ${meant}`, second.length ? ", read as hexadecimal" : ""),
        data.fields && (!shown.length || shown.some(([kind]) => kind === "device")) ? errorParts(meant) : null,
        ...shown.map((entry) => errorCard(entry, meant)),
        shown.length ? null : messages(["No error of this manual has this number."]),
      );
    });

    fields.number.value = asked().get("number") ?? "";
    form.addEventListener("input", () => {
      update();
      remember({ number: fields.number.value.trim() });
    });
    update();
  }

  // ---- Code and index.

  function startConverter() {
    const it = instrument("converter");
    if (!it) return;
    const { form, fields, idle, show, guarded } = it;
    const base = BigInt(data.base);
    const ranges = idle.slice(1);
    const split = (text) => {
      const [whole, sub = ""] = text.trim().split(/[/:.]/);
      const part = sub ? typed(sub) : null;
      return sub && part === null ? null : [whole.trim(), part];
    };
    const joined = (text, part) => (part === null ? text : `${text}/${part}`);
    // The code that each control names; undefined where it is none.
    const readers = {
      code: (text) => (/^c?0*\d{1,6}$/i.test(text) ? BigInt(text.replace(/^c/i, "")) : indexesIn(text).map((index) => base - index)[0]),
      index: (text) => (/^\d+$/.test(text) ? base - BigInt(text) : undefined),
      hex: (text) => (/^(?:i-|0x)?[0-9a-f]+h?$/i.test(text) ? base - BigInt(`0x${text.replace(/^(?:i-|0x)|h$/gi, "")}`) : undefined),
    };

    const indexesIn = (text) => readings(text.toLowerCase()).filter((it) => it.spaces.includes("i") && Number.isSafeInteger(it.number)).map((it) => BigInt(it.number));
    const codesIn = (text) => readings(text.toLowerCase()).filter((it) => it.spaces.includes("c") && Number.isSafeInteger(it.number)).map((it) => BigInt(it.number));

    // Codes and objects of this manual that a text means in other notations than that of its control.
    function alternatives(text) {
      const indexes = [...codesIn(text).map((code) => base - code), ...indexesIn(text)];
      const found = new Map(indexes.map((index) => [index, entryAt(index)]).filter(([, entry]) => entry));
      return found.size ? [["Could also be", ...[...found.values()].flatMap(([key, href, name], nth) => [nth ? ", " : "", link(href, key), ` ${name}`])]] : [];
    }

    // Designation, address and name of the code or object with an index.
    function entryAt(index) {
      const code = data.codes[base - index];
      return data.objects[index] ?? (code ? [designation(base - index), code[1], code[0]] : null);
    }

    function convert(name, text) {
      const parts = split(text);
      const code = parts ? readers[name](parts[0]) : undefined;
      if (code === undefined || code < 0n || code > base) return null;
      const index = base - code;
      const object = data.objects[index];
      return { code, part: parts[1], object, texts: { code: object ? "" : joined(designation(code), parts[1]), index: joined(String(index), parts[1]), hex: joined(inHex(index, 4), parts[1]) } };
    }

    const update = guarded((name) => {
      const text = fields[name].value;
      if (!text.trim()) {
        for (const other of Object.keys(readers)) fields[other].value = "";
        return show(...idle);
      }
      const found = convert(name, text);
      for (const other of Object.keys(readers)) if (other !== name) fields[other].value = found ? found.texts[other] : "";
      if (!found) return show(facts(alternatives(text)), messages([`'${text.trim()}' is no ${name === "code" ? "code" : "index of a code"}: codes go from 0 to ${base}.`]), ...ranges);
      const known = data.codes[found.code];
      const slot = slotOf(found.code);
      const twin = slot && data.slots.find((other) => other !== slot);
      const twinCode = twin ? found.code - BigInt(slot[3]) + BigInt(twin[3]) : null;
      const wrong = known && found.part !== null && found.part > BigInt(known[2]) ? [`${designation(found.code)} has ${known[2] || "no"} subcodes.`] : [];
      show(
        facts([
          found.object
            ? ["Object", link(found.object[1], joined(found.object[0], found.part)), ` ${found.object[2]}`]
            : ["Code", link(known?.[1], found.texts.code), known ? ` ${known[0]}` : ", not in this manual"],
          ...(known || found.object ? [] : alternatives(text)),
          ["Index", `${found.texts.index} = ${found.texts.hex}`],
          slot ? ["Slot", slot[0]] : null,
          twin ? [`The same in ${twin[0]}`, link(data.codes[twinCode]?.[1], joined(designation(twinCode), found.part)), `, index ${base - twinCode} = ${inHex(base - twinCode, 4)}`] : null,
        ]),
        messages(wrong),
        ...(slot ? [] : ranges),
      );
    });

    const slotOf = (code) => data.slots.find(([, first, last]) => BigInt(first) <= code && code <= BigInt(last));

    block.convert = convert;
    const state = asked();
    fields.code.value = state.get("convert") ?? "";
    form.addEventListener("input", (event) => {
      update(event.target.name);
      const shown = convert(event.target.name, event.target.value);
      remember({ convert: shown?.object ? joined(shown.object[0], shown.part) : fields.code.value.trim() });
    });
    update("code");
  }

  // One that fails to begin does not keep the others from it.
  for (const start of [startBuilder, startDecoder, startErrors, startConverter]) {
    try {
      start();
    } catch (error) {
      reportError(error);
    }
  }
})();
