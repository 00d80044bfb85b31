// The replay that stands in this file.

import { showReplay } from './replay.js';

const log = JSON.parse(document.getElementById('replay').textContent);
globalThis.typhon = showReplay(document.body, log);
