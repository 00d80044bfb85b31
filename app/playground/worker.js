// Runs Prolog: queries and orders of the page, and virtual time in slices. It
// takes {do: 'first'}, {do: 'save', files} and {ask: text}, with an id, and sends
// {id, reply} or {id, error}, {frame}, {said: [line]}, and {ended: why} at last.

'use strict';

const SLICE = 0.03;             // s of work between two looks at messages
const SOON = 0.25;              // s, at most, between two slices
const LINES = 2000;             // of output between two messages
const MEMORY = 2 ** 29;         // bytes
let prolog = null, FS = null, full = false, timer = null, said = [];

const say = line => {
  if (said.length < LINES) said.push(line);
};

// The rights of this worker end here: Prolog has no way to JavaScript, and
// JavaScript none to the network.
function closeDoors() {
  for (const name of ['fetch', 'XMLHttpRequest', 'WebSocket', 'EventSource',
    'WebTransport', 'indexedDB', 'caches', 'importScripts', 'Worker', 'BroadcastChannel'])
    try {
      Object.defineProperty(self, name, { value: undefined, configurable: false });
    } catch { /* not there */ }
}

// Prolog gets no more memory than this, and reports it or breaks; the worker ends
// then.
function bound(memory) {
  memory.grow = pages => {
    full ||= memory.buffer.byteLength + 65536 * pages > MEMORY;
    if (full) throw new RangeError('Too much memory');
    return WebAssembly.Memory.prototype.grow.call(memory, pages);
  };
}

function endIfFull() {
  if (!full) return;
  postMessage({ said, ended: 'It used too much memory, so it was stopped' });
  close();
}

function save(files) {
  for (const [name, text] of Object.entries(files)) {
    FS.mkdirTree(name.replace(/\/[^/]*$/, ''));
    FS.writeFile(name, text);
  }
}

const load = async name => (await fetch(name)).arrayBuffer();

// Compile the module while it comes, also if the server does not know its type.
async function compile() {
  const { body } = await fetch('swipl.wasm');
  return WebAssembly.compileStreaming(
    new Response(body, { headers: { 'Content-Type': 'application/wasm' } }));
}

async function begin() {
  const got = Promise.all([compile(), load('typhon.state'), load('sources.json')]);
  importScripts('swipl.js');
  const [module, state, sources] = await got;
  ({ FS, prolog } = await SWIPL({
    arguments: ['-x', '/typhon.state', '-q', '--stack-limit=256m'],
    print: say, printErr: say,
    preRun: [made => made.FS.writeFile('/typhon.state', new Uint8Array(state))],
    async instantiateWasm(imports, made) {
      const instance = await WebAssembly.instantiate(module, imports);
      bound(Object.values(instance.exports).find(value =>
        value instanceof WebAssembly.Memory));
      made(instance);
    },
  }));
  closeDoors();
  save(JSON.parse(new TextDecoder().decode(sources)));
  once('platform_boot');
  once('typhon_playground:playground_begin');
}

function once(goal, input = {}) {
  const answer = prolog.query(goal, input).once();
  if (answer.error || !answer.success) throw new Error(answer.message || `${goal} failed`);
  return answer;
}

const text = value => (typeof value === 'object' ? value.v ?? String(value) : String(value));

function news() {
  const frame = text(once('typhon_page_tab:tab_news(Json)').Json);
  if (frame) postMessage({ frame });
  if (said.length > 0) postMessage({ said });
  said = [];
}

function slice() {
  timer = null;
  const { More } = once(`typhon_page_tab:tab_slice(${SLICE}, More)`);
  news();
  if (Number(More) >= 0) timer = setTimeout(guarded(slice), 1000 * Math.min(SOON, Number(More)));
}

const guarded = act => () => {
  try { act(); } catch (error) { say(error.message); postMessage({ said }); said = []; }
  endIfFull();
};

const ready = begin();

onmessage = async ({ data: { id, ...message } }) => {
  try {
    await ready;
    if (message.do === 'save')
      postMessage({ id, reply: save(message.files) });
    else if (message.do === 'first')
      postMessage({ id, reply: 'ready',
        frame: text(once('typhon_page_tab:tab_first(Json)').Json) });
    else
      postMessage({ id, reply: text(once('typhon_page_tab:tab_ask(In, Out)',
        { In: message.ask }).Out) });
    news();
    clearTimeout(timer);
    timer = setTimeout(guarded(slice), 0);
  } catch (error) {
    postMessage({ id, error: error.message, said });
    said = [];
  }
  endIfFull();
};
