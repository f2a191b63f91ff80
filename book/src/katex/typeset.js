// Formulas of the book: blocks that are marked `math`, and code between dollars, $`x`$. GitHub shows both in the same way.
document.addEventListener("DOMContentLoaded", () => {
  const typeset = (code, place, displayMode) => {
    const formula = document.createElement(displayMode ? "div" : "span");
    katex.render(code.textContent, formula, { displayMode, throwOnError: false });
    place.replaceWith(formula);
  };
  for (const code of document.querySelectorAll("code.language-math")) typeset(code, code.closest("pre"), true);
  for (const code of document.querySelectorAll("code")) {
    const [before, after] = [code.previousSibling, code.nextSibling];
    if (before?.nodeValue?.endsWith("$") && after?.nodeValue?.startsWith("$")) {
      before.nodeValue = before.nodeValue.slice(0, -1);
      after.nodeValue = after.nodeValue.slice(1);
      typeset(code, code, false);
    }
  }
});
