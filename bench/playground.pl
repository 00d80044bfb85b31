:- use_module('../test/lib/common', []).
:- use_module(common).
:- use_module('../test/lib/browser',
              [ browser_open/2, browser_run/3, browser_wait/2, with_browser/2 ]).
:- use_module('../test/lib/playground_scenes', [with_playground/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [last/2, member/2, min_list/2, nth1/3]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

/*  The playground: its bytes as a server sends them, compressed by Brotli; from
    the first request to the first paint, and from Set up to the first agent, in a
    new Chromium each time, the best of some. The times of processors are those of
    the whole browser. */

:- initialization(main, main).

main(_) :-
    with_playground(Dir, Address, measured(Dir, Address)).

measured(Dir, Address) :-
    bytes(Dir, All, Studies),
    figure('playground, all files', All, 'kB by Brotli'),
    figure('playground, of that only with a study', Studies, 'kB by Brotli'),
    findall(Paint-Agent-Spent,
            ( between(1, 5, _),
              with_browser(Browser, visit(Browser, Address, Paint, Agent, Spent)) ),
            Visits),
    best('playground, first paint', Paint, Paint-_-_, Visits, ms),
    best('playground, first agent', Agent, _-Agent-_, Visits, ms),
    best('playground, first agent', Spent, _-_-Spent, Visits, 'ms of processor').

best(Name, Value, Visit, Visits, Unit) :-
    findall(Value, member(Visit, Visits), Values),
    min_list(Values, Best),
    figure(Name, Best, Unit).

bytes(Dir, All, Studies) :-
    Script = "const fs = require('fs'), z = require('zlib'), [dir] = process.argv.slice(1);\c
        const size = name => z.brotliCompressSync(fs.readFileSync(`${dir}/${name}`)).length;\c
        const all = fs.readdirSync(dir).reduce((sum, name) => sum + size(name), 0);\c
        console.log(`${all}-${size('studies.json')}.`)",
    setup_call_cleanup(
        process_create(path(node), ['-e', Script, Dir], [stdout(pipe(Out))]),
        read(Out, All0-Studies0),
        close(Out)),
    All is All0/1000,
    Studies is Studies0/1000.

visit(Browser, Address, Paint, Agent, Spent) :-
    browser_open(Browser, Address),
    browser_wait(Browser, "return globalThis.playground?.page?.files.size > 0 \c
        && performance.getEntriesByName('first-contentful-paint').length"),
    browser_run(Browser, "return performance\c
        .getEntriesByName('first-contentful-paint')[0].startTime", Paint),
    browser_seconds(Before),
    browser_run(Browser, "const start = performance.now();\c
        [...document.querySelectorAll('#play button')]\c
            .find(button => button.textContent === 'Set up').click();\c
        while (typhon.store.agents.size === 0)\c
            await new Promise(done => setTimeout(done, 2));\c
        return performance.now() - start", Agent),
    browser_seconds(After),
    Spent is 1000*(After-Before).

%   The processes that come from this one.

browser_seconds(Seconds) :-
    findall(Parent-(Pid-Ticks), process_spent(Pid, Parent, Ticks), Processes),
    current_prolog_flag(pid, Me),
    aggregate_all(sum(Ticks), below(Me, Processes, Ticks), Sum),
    Seconds is Sum/100.

below(Pid, Processes, Ticks) :-
    member(Pid-(Child-Spent), Processes),
    ( Ticks = Spent ; below(Child, Processes, Ticks) ).

process_spent(Pid, Parent, Ticks) :-
    directory_files('/proc', Names),
    member(Name, Names),
    atom_number(Name, Pid),
    atomic_list_concat(['/proc/', Name, '/stat'], File),
    catch(read_file_to_string(File, Text, []), error(_, _), fail),
    split_string(Text, ")", "", Parts),
    last(Parts, Fields0),               % behind a name, which may have spaces
    split_string(Fields0, " ", "", [_,_|Fields]),
    nth1(1, Fields, ParentText),
    nth1(11, Fields, User),
    nth1(12, Fields, System),
    maplist(number_string, [Parent,U,S], [ParentText,User,System]),
    Ticks is U+S.
