// node play.js STATE FROM FOLDER TO: answers the queries in the folders of FROM as
// play.pl does, in a process from the saved STATE, where FROM has the name FOLDER,
// and writes its files to TO.

const fs = require('fs');
const path = require('path');
const { boot, mount, sources, succeed, there } =
  require('../../../app/playground/state.js');
const [state, from, folder, to] = process.argv.slice(2);

function copy(FS, source, target) {
  FS.mkdirTree(target);
  for (const name of fs.readdirSync(source)) {
    const file = path.join(source, name);
    if (fs.statSync(file).isDirectory()) copy(FS, file, `${target}/${name}`);
    else FS.writeFile(`${target}/${name}`, fs.readFileSync(file));
  }
}

function save(FS, source, target) {
  fs.mkdirSync(target, { recursive: true });
  for (const name of FS.readdir(source)) {
    if (name === '.' || name === '..') continue;
    const file = `${source}/${name}`;
    if (FS.isDir(FS.stat(file).mode)) save(FS, file, path.join(target, name));
    else fs.writeFileSync(path.join(target, name), FS.readFile(file));
  }
}

boot(fs.readFileSync(state), console.log, console.error)
  .then((Module) => {
    mount(Module, [...['agents', 'payloads', 'experiments',
      'examples/studies'].filter(there).flatMap(sources), 'test/lib/wasm/play.pl']);
    copy(Module.FS, from, folder);
    succeed(Module, "consult('/typhon/test/lib/wasm/play.pl')");
    for (const name of fs.readdirSync(from).sort())
      succeed(Module, `play('${folder}/${name}')`);
    save(Module.FS, folder, to);
  })
  .catch((error) => {
    console.error(error.message);
    process.exitCode = 1;
  });
