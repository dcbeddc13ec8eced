// A page of sections: each table is made when it is opened.
function openSheet(number) {
  const root = $(`sheet-${number}`), sheet = DATA.sheets[number];
  if (root.firstChild) return;
  const bad = new Uint8Array(bytes(sheet.bad)), columns = sheet.columns.map(unpackedColumn);
  new Grid(root, columns, bad.length, { label: sheet.title, wrap: sheet.wrap, last: row => bad[row] === 1, mark: row => bad[row] ? "bad" : "" });
}

document.querySelectorAll(".sheet").forEach(details => {
  const number = Number(details.querySelector(".rows").id.split("-")[1]);
  details.addEventListener("toggle", () => { if (details.open) openSheet(number); });
  if (details.open) openSheet(number);
});
