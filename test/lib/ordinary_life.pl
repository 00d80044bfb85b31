:- module(test_ordinary_life, []).

/** <module> What a user does with the library, in a process of its own

A network of two processes, an agent that visits the other host, a message, a
log, the page. The program prints what came of it, the same each time, and
ends. The other process runs the program that the variable TYPHON_QUICK names,
if there is one: nothing of the user comes there.

*Threading*: the main thread.
*/

:- use_module(common, [with_tmp_dir/1]).
:- current_prolog_flag(iso, Iso),
   set_prolog_flag(iso, false),         % library(http) does not load so
   use_module(pages, [ask/3, with_page/3]),
   set_prolog_flag(iso, Iso).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/network/node_program), []).

:- initialization(life, main).

life :-
    children_start_quickly,
    with_tmp_dir(life).

children_start_quickly :-
    getenv('TYPHON_QUICK', Quick),
    !,
    wrap_predicate(typhon_node_program:swipl(Swipl), quick, _, Swipl=Quick).
children_start_quickly.

life(Dir) :-
    directory_file_path(Dir, log, Log),
    setup_call_cleanup(
        network_start(ring(2), Network, [processes(2), log(Log)]),
        with_page([], Base, life(Network, Base)),
        network_stop(Network)),
    read_file_to_terms(Log, Events, []),
    findall(What, member(event(_, _, _, What), Events), Logged0),
    msort(Logged0, Logged),             % threads write
    format("~q~n", [Logged]).

life(Network, Base) :-
    network_property(Network, hosts([Here, There])),
    agent_create(clauses([ (:- agent(visitor, [state([seen/1])])),
                           (main :-
                               receive(_-go(To)),
                               home(Home),
                               move(To),
                               assertz(seen("a string")),
                               log([1.5, 'An atom']),
                               move(Home),
                               seen(What),
                               result(What)) ]),
                 Agent, [host(Here)]),
    agent_send(Agent, go(There)),
    agent_result(Agent, Seen, 30),
    remote(There, X is 6*7),
    set_prolog_flag(stream_type_check, loose),  % for the client of library(http)
    ask(Base, _{ask:"survey"}, Survey),
    dict_pairs(Survey.answer, _, Pairs),
    findall(Key, member(Key-_, Pairs), Keys),
    format("~q~n", [life(Seen, X, Keys)]).
