// Looks up words in `sections` (sections.js). A section is found when each
// word, or what it is called here, is in its title, its text or the title of its
// page.

const synonyms = {
    actor: "agent", behavior: "behaviour", broadcast: "watch",
    checkpoint: "restore", color: "colour", container: "host",
    cookie: "token", daemon: "host", deploy: "deliver", encryption: "tls",
    exception: "error", failover: "restart", inbox: "mailbox",
    kill: "dispose", latency: "hop_time", migrate: "move",
    migration: "move", monitor: "watch", neighbor: "neighbour",
    neighbors: "neighbours", node: "host", persistence: "journal",
    sandbox: "guarded",
    simulation: "virtual", spawn: "create", supervisor: "restart",
    supervision: "restart", topology: "shape",
};

function search(query, limit = 20) {
    const words = query.toLowerCase().split(/\s+/).filter(w => w);
    if (words.length === 0) return [];
    return sections
        .map(section => ({section, score: score(section, words)}))
        .filter(hit => hit.score > 0)
        .sort((a, b) => b.score - a.score)
        .slice(0, limit)
        .map(hit => ({...hit.section, around: around(hit.section, words)}));
}

function score(section, words) {
    const title = section.title.toLowerCase();
    const page = section.page.toLowerCase();
    const text = section.text.toLowerCase();
    let sum = 0;
    const points = word =>
        title === word || title.startsWith(word + "/") ? 100 :
        title.startsWith(word) ? 40 :
        title.includes(word) ? 20 :
        page.includes(word) ? 5 :
        text.includes(word) ? 1 : 0;
    for (const word of words) {
        const most = Math.max(points(word), points(synonyms[word] ?? word));
        if (most === 0) return 0;
        sum += most;
    }
    return sum;
}

function around(section, words) {
    const at = Math.max(0, ...words.flatMap(word => [word, synonyms[word] ?? word])
        .map(word => section.text.toLowerCase().indexOf(word)));
    const start = Math.max(0, at - 40);
    return (start > 0 ? "…" : "") + section.text.slice(start, start + 120);
}

function show(found, query) {
    const hits = search(query);
    if (hits.length === 0 && query.trim() !== "") {
        const none = document.createElement("p");
        none.textContent = "No results for “" + query.trim() + "”";
        found.replaceChildren(none);
        return;
    }
    found.replaceChildren(...hits.map(hit => {
        const link = document.createElement("a");
        const text = document.createElement("small");
        link.href = hit.at;
        link.append(hit.title === hit.page
            ? hit.title : hit.title + " · " + hit.page);
        text.textContent = hit.around;
        link.append(text);
        return link;
    }));
}

if (typeof document !== "undefined") {
    const field = document.getElementById("search");
    const found = document.getElementById("found");
    field.addEventListener("input", () => show(found, field.value));
    field.addEventListener("keydown", event => {
        if (event.key === "Enter") found.querySelector("a")?.click();
        if (event.key === "Escape") { field.value = ""; show(found, ""); }
    });
    document.addEventListener("keydown", event => {
        if (event.key === "/" && event.target === document.body) {
            event.preventDefault();
            field.focus();
        }
    });
}
