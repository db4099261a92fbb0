// Colour maps: anchors [level, red, green, blue], linear in between; the first map is that of the picture files.

const anchors = {
  amber: [[0, 6, 5, 6], [40, 44, 22, 6], [96, 120, 62, 8], [150, 204, 118, 14], [200, 246, 180, 48], [235, 255, 226, 140],
          [255, 255, 252, 236]],
  copper: [[0, 0, 0, 0], [203, 255, 159, 101], [255, 255, 199, 127]],
  gray: [[0, 0, 0, 0], [255, 255, 255, 255]],
  ice: [[0, 2, 6, 14], [70, 8, 44, 92], [140, 24, 118, 176], [205, 120, 206, 232], [255, 244, 255, 255]],
  viridis: [[0, 68, 1, 84], [64, 59, 82, 139], [128, 33, 145, 140], [191, 94, 201, 98], [255, 253, 231, 37]],
  inferno: [[0, 0, 0, 4], [51, 66, 10, 104], [102, 147, 38, 103], [153, 221, 81, 58], [204, 252, 165, 10], [255, 252, 255, 164]],
};

export const names = Object.keys(anchors);

/** Returns 256 colours of 4 bytes. */
export function palette(name) {
  const list = anchors[name], colours = new Uint8Array(1024);
  for (let level = 0, i = 0; level < 256; ++level) {
    while (level > list[i + 1][0]) ++i;
    const share = (level - list[i][0]) / (list[i + 1][0] - list[i][0]);
    for (let c = 0; c < 3; ++c) colours[4 * level + c] = Math.round(list[i][c + 1] * (1 - share) + list[i + 1][c + 1] * share);
    colours[4 * level + 3] = 255;
  }
  return colours;
}
