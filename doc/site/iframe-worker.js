// The theme searches in a Worker, which browsers refuse for pages that are
// files. This one runs the script in a frame, and adds to each word of a query
// what it is called here.

const synonyms = {
    actor: "agent", behavior: "behaviour", breakpoint: "spy",
    checkpoint: "restore", color: "colour", daemon: "service",
    deploy: "deliver", encryption: "tls", exception: "error",
    failover: "supervisor", inbox: "mailbox", kill: "dispose",
    latency: "cost", migrate: "move", migration: "move",
    neighbor: "neighbour", neighbors: "neighbours", node: "host",
    persistence: "journal", simulation: "virtual", spawn: "create",
};

const QUERY = 2;                        // a type of the theme's messages

window.Worker = class extends EventTarget {
    constructor(url) {
        super();
        const frame = document.createElement("iframe");
        frame.hidden = true;
        document.body.append(frame);
        this.inside = frame.contentWindow;
        this.inside.postMessage = data =>
            this.dispatchEvent(new MessageEvent("message", { data }));
        const script = frame.contentDocument.createElement("script");
        script.src = url;
        this.ready = new Promise(resolve => script.onload = resolve);
        frame.contentDocument.body.append(script);
    }

    async postMessage(message) {
        await this.ready;
        const data = message.type === QUERY
            ? { ...message, data: translated(message.data) } : message;
        this.inside.dispatchEvent(new MessageEvent("message", { data }));
    }
};

function translated(query) {
    return query.replace(/\w+/g, word => {
        const other = synonyms[word.toLowerCase()];
        return other ? `${word} ${other}` : word;
    });
}
