"use strict";
// How people write numbers: what the search and the instruments read.
const readings = (() => {
  // A number in the notations of manuals, tools and bus monitors: letter of the space, digits, part after a separator.
  const NUMBER = /^(c|i|pnu|e)?-?(0x)?([0-9a-f]+)(h)?(?:(?:[/.:-]|sub)(0x)?([0-9a-f]{1,3})(h)?)?$/;
  const OCTETS = /^[0-9a-f]{2}(?:[ ,-][0-9a-f]{2}){1,3}$/;
  const SPACES = { c: "c", i: "i", pnu: "p", e: "de", "": "cidepb" };

  // Everything that the text may mean as a number, the likeliest first: spaces to look in, number, parts to look for.
  return function readings(text) {
    const found = [];
    if (OCTETS.test(text)) {
      const octets = text.split(/[ ,-]/);
      // As a list writes it, then as it travels on a bus that sends the low byte first.
      for (const order of [octets, octets.toReversed()]) {
        found.push({ spaces: "dei", number: parseInt(order.join(""), 16), parts: [] });
      }
      return found;
    }
    // A separator at the end begins a part that is still to be typed.
    const tight = text.replace(/[\s_']/g, "").replace(/(?<=[\da-f])(?:[/.:-]|su?b?)$/, "");
    if (/^-\d+$/.test(tight)) return [{ spaces: "de", number: Number(tight) >>> 0, parts: [] }];
    const match = NUMBER.exec(tight);
    if (!match) return found;
    const [, letter = "", mark, digits, tail, partMark, part, partTail] = match;
    const parts = [];
    if (part !== undefined) {
      if (!partMark && !partTail && /^\d+$/.test(part)) parts.push(parseInt(part, 10));
      const inHex = parseInt(part, 16);
      if (!parts.includes(inHex)) parts.push(inHex);
    }
    const decimal = /^\d+$/.test(digits) && !mark && !tail;
    if (decimal && letter !== "i") found.push({ spaces: SPACES[letter], number: parseInt(digits, 10), parts });
    if (letter === "c" && !mark && !tail) {
      // "c13350" is also hexadecimal, of which people rarely think.
      if (part === undefined) found.push({ spaces: "ide", number: parseInt(letter + digits, 16), parts });
    } else if (letter !== "pnu") {
      found.push({ spaces: SPACES[letter].replace(/[cp]/g, ""), number: parseInt(digits, 16), parts });
    }
    // "e" may be the first digit of an index.
    if (letter === "e" && !mark) found.push({ spaces: "ideb", number: parseInt(letter + digits, 16), parts });
    if (decimal && letter === "i") found.push({ spaces: "i", number: parseInt(digits, 10), parts });
    return found;
  };
})();
