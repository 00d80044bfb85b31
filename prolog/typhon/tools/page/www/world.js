// The view World: the picture of the surroundings of agents, on a page with the
// option world(Goal). It is shown as an image, so that no script in it runs.

import { element } from './dom.js';

const PAUSE = 500;              // ms between pictures

export const mount = (parent, store, app) => new World(parent, app);

class World {
  constructor(parent, app) {
    this.app = app;
    this.image = element('img', { alt: 'The world, as it is now' });
    this.said = element('p', { class: 'empty', hidden: true });
    parent.append(element('section', { class: 'view view-world',
      'aria-label': 'World' }, this.image, this.said));
    this.again();
  }

  async again() {
    if (!document.hidden && this.app.view === 'world' && this.app.state === 'open')
      await this.look();
    setTimeout(() => this.again(), PAUSE);
  }

  async look() {
    try {
      this.show(await this.app.ask({ ask: 'world' }));
    } catch (error) {
      this.said.textContent = error.message;
      this.said.hidden = false;
    }
  }

  // The previous picture is released only after the next one is decoded.
  show(svg) {
    const before = this.image.src;
    this.image.src = URL.createObjectURL(new Blob([svg], { type: 'image/svg+xml' }));
    this.said.hidden = true;
    if (before) this.image.decode().catch(() => {})
      .then(() => URL.revokeObjectURL(before));
  }
}
