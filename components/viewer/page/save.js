// Saves the picture of a ping as a file.
import {attitudeTexts} from './attitude.js';
import {element} from './tables.js';

const caption_px = 22;

/** Returns the picture with its overlays, and a line that names the ping. */
function pictureOf(fan, attitude) {
  const {width, height} = fan.canvas, caption = caption_px * devicePixelRatio;
  const canvas = element('canvas', {width, height: height + caption}), context = canvas.getContext('2d');
  context.fillStyle = '#0a0d10';
  context.fillRect(0, 0, width, height + caption);
  for (const layer of [fan.canvas, fan.overlay]) context.drawImage(layer, 0, 0);
  context.fillStyle = '#b9c4cd';
  context.font = `${12 * devicePixelRatio}px system-ui, "DejaVu Sans", sans-serif`;
  const told = Object.entries(attitude ? attitudeTexts(attitude) : {}).map(([name, text]) => `${name} ${text}`);
  context.fillText([fan.ping.source, `${(fan.ping.time_us * 1e-6).toFixed(3)} s`, ...told].join('   '), caption / 3, height + 0.7 * caption, width - caption);
  return canvas;
}

/** Downloads the picture as SOURCE_MICROSECONDS.png. */
export async function savePicture(fan, attitude) {
  if (!fan.ping) return;
  const {source, time_us} = fan.ping;
  fan.draw();
  const blob = await new Promise((done) => pictureOf(fan, attitude).toBlob(done, 'image/png'));
  const link = element('a', {href: URL.createObjectURL(blob), download: `${source}_${time_us}.png`});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
