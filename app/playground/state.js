// node app/playground/state.js STATE: writes a saved state of the playground, or of
// the platform alone, for SWI-Prolog for WebAssembly.  boot() starts a process from it.

'use strict';
const fs = require('fs');
const path = require('path');

const root = path.join(__dirname, '../..');
const engine = path.join(root, 'test/lib/wasm');
const there = (name) => fs.existsSync(path.join(root, name));
const LOADED = ['prolog', 'app/playground', 'experiments/engine'].filter(there);
const PROGRAM = ['playground', 'platform'].map((name) => `app/playground/${name}.pl`)
  .find(there);

// The names of the files NAME.pl below a folder of the project.
function sources(folder) {
  return fs.readdirSync(path.join(root, folder), { withFileTypes: true })
    .flatMap((entry) => {
      const name = `${folder}/${entry.name}`;
      if (entry.isDirectory()) return sources(name);
      return name.endsWith('.pl') ? [name] : [];
    });
}

// Files of the project are below /typhon.
function mount(Module, names) {
  for (const name of names) {
    const target = `/typhon/${name}`;
    Module.FS.mkdirTree(path.posix.dirname(target));
    Module.FS.writeFile(target, fs.readFileSync(path.join(root, name)));
  }
}

function succeed(Module, goal) {
  const answer = Module.prolog.query(goal).once();
  if (answer.success !== true) throw new Error(`${goal}: ${answer.message}`);
}

// The bytes of a state in which PROGRAM is loaded.
async function save() {
  const said = [];
  const Module = await require(path.join(engine, 'swipl-bundle.js'))({
    arguments: ['-q'],
    print: (line) => said.push(line),
    printErr: (line) => said.push(line),
  });
  mount(Module, [...LOADED.flatMap(sources), 'pack.pl']);
  succeed(Module, `use_module('/typhon/${PROGRAM}'), ` +
          "use_module('/typhon/app/playground/platform.pl'), " +
          "platform_save('/typhon.state')");
  if (said.length > 0) throw new Error(said.join('\n'));
  return Module.FS.readFile('/typhon.state');
}

// A process that began with the bytes of a state.  print and printErr get the
// lines that it prints.
async function boot(state, print, printErr) {
  const Module = await require(path.join(engine, 'swipl-bundle-no-data.js'))({
    arguments: ['-x', '/typhon.state', '-q'],
    preRun: [(Module) => Module.FS.writeFile('/typhon.state', state)],
    print,
    printErr,
  });
  succeed(Module, 'platform_boot');
  return Module;
}

module.exports = { boot, mount, save, sources, succeed, there };

if (require.main === module)
  save().then((state) => fs.writeFileSync(process.argv[2], state))
    .catch((error) => {
      console.error(error.message);
      process.exitCode = 1;
    });
