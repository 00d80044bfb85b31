// Views as files: SVG as the view draws it, PNG from that, twice as fine.

import { button } from './dom.js';

export function download(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export const svgBlob = text => new Blob([text], { type: 'image/svg+xml' });

// draw(pen) draws on a canvas what toSVG draws as SVG.
export async function pngBlob(width, height, draw, scale = 2) {
  const canvas = document.createElement('canvas');
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  const pen = canvas.getContext('2d');
  pen.scale(scale, scale);
  draw(pen);
  return new Promise(resolve => canvas.toBlob(resolve, 'image/png'));
}

// Two buttons, for a view with toSVG and toPNG.
export const saveButtons = (name, view) => [
  button('SVG', async () => download(`${name}.svg`, svgBlob(await view.toSVG())),
    { title: 'Save this view as SVG', 'aria-label': `Save ${name} as SVG` }),
  button('PNG', async () => download(`${name}.png`, await view.toPNG()),
    { title: 'Save this view as PNG', 'aria-label': `Save ${name} as PNG` }),
];
