// What is left out of the scene, below it.

export function addShapesNote(host, omitted) {
  host.textContent = omitted.length > 0 ? `${omitted.length} shapes were left out: see ?` : "";
}
