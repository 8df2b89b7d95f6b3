// Unpacks the script of the page and puts it into the page, whose policy knows its hash.

(async () => {
  const { bytesOf, inflate } = modules["unpack.js"], place = document.createElement("script");
  place.textContent = new TextDecoder().decode(await inflate(bytesOf("data-script")));
  document.head.append(place);
  place.remove();
})().catch((error) => {
  document.getElementById("notice").textContent = `This page cannot be shown: ${error.message}.`;
});
