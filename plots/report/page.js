// SPDX-License-Identifier: GPL-3.0-or-later
// What every page has: light or dark, tables to sort and filter, links to the sections that are there.
const page = (function () {
  "use strict";

  // ---- theme
  const isDark = () => {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  };
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // ---- tables
  function initTables() {
    jQuery("table.sortable").each(function () {
      const table = this, filtered = table.dataset.filters.split(" ").filter(Boolean).map(Number);
      const shown = jQuery(table).DataTable({ paging: false, order: [], orderCellsTop: true,
        language: { search: "Filter the rows:" } });
      filtered.forEach((column) => {
        const header = shown.column(column).header(), select = document.createElement("select");
        select.setAttribute("aria-label", "Only rows with this " + header.textContent);
        const texts = [...new Set(shown.column(column).nodes().toArray().map((cell) => cell.textContent))].sort();
        select.append(new Option("all", ""), ...texts.map((text) => new Option(text, text)));
        select.addEventListener("click", (event) => event.stopPropagation());
        select.addEventListener("change", () => shown.column(column).search(
          select.value ? "^" + jQuery.fn.dataTable.util.escapeRegex(select.value) + "$" : "", true, false).draw());
        header.append(select);
      });
    });
  }

  // redraw: what follows the colours; ready: when everything else is there.
  const shared = { isDark: isDark, css: css, redraw: () => {}, ready: () => {
    initTables();
    document.documentElement.dataset.ready = "yes";
  } };
  document.getElementById("theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    document.getElementById("theme").setAttribute("aria-pressed", String(isDark()));
    shared.redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => shared.redraw());
  document.querySelectorAll("nav a").forEach((a) => { a.hidden = !document.querySelector(a.getAttribute("href")); });
  return shared;
})();
