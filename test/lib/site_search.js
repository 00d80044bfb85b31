// node site_search.js SITE: searches the site at SITE for each line of standard
// input, by the scripts of its pages, and prints a line of JSON for each: the
// pages found, the best first.

const fs = require("fs");
const path = require("path");
const vm = require("vm");

const site = process.argv[2];
const SETUP = 0, QUERY = 2;             // types of the theme's messages

function script(file, globals) {
    const context = vm.createContext({ console, EventTarget, ...globals });
    context.self = context.window = context;
    vm.runInContext(fs.readFileSync(file, "utf8"), context);
    return context;
}

// The page's own words for those of a query.

const { translated } = script(path.join(site, "iframe-worker.js"), {});

// The theme's Worker answers each message by one.

const workers = path.join(site, "assets/javascripts/workers");
let listener, answered;
const name = fs.readdirSync(workers).find(file => /^search\..*\.js$/.test(file));
script(path.join(workers, name),
       { addEventListener: (_, heard) => listener = heard,
         postMessage: answer => answered(answer) });

const ask = data => new Promise(resolve => {
    answered = resolve;
    listener({ data });
});

async function main() {
    const file = path.join(site, "search/search_index.json");
    const index = JSON.parse(fs.readFileSync(file, "utf8"));
    await ask({ type: SETUP, data: { ...index, options: { suggest: false } } });
    for (const words of fs.readFileSync(0, "utf8").split("\n").filter(Boolean)) {
        const { data } = await ask({ type: QUERY, data: translated(words) });
        const pages = data.items.map(found => found[0].location.split("#")[0]);
        console.log(JSON.stringify(pages));
    }
}

main();
