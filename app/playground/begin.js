// Before the scripts of the page: its hosts are in a worker of this tab, which
// begins with the first click on Set up; see connection.js.

'use strict';

{
  let begun = null;
  globalThis.playground = { begin: null };
  const clicked = new Promise(resolve => { globalThis.playground.begin = resolve; });
  globalThis.typhonWorker = async () => {
    await clicked;
    begun = new Worker('worker.js');
    return begun;
  };
}
