:- module(typhon_python_service, []).
:- use_module(library(apply), [maplist/2, maplist/3, maplist/4]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [ inbox_put/4, service/2, service_begin/5, service_offer/4,
                subscriber/2 ]).
:- use_module('../helper',
              [ helper_call/5, helper_close/1, helper_file/2, helper_note/2,
                helper_open/3, helper_python/2 ]).

/** <module> Python on a host

The functions of Python files are predicates of the place.  On a host with the
option python(true) an agent may deliver a payload that was read from a `.py`
file: the place has its functions as predicates until undeliver/1.  They run in
the process that python_start/3 has started, or else in one that is started for
them.

Python code can do all that the user of this process may do.

*Threading*: any thread; a thread waits only for the answer of its own call.
The thread that reads from Python delivers its unsolicited messages.
*/

:- multifile
    typhon_starting:starts/4,
    typhon_helper_owner:handle_message/2,
    typhon_helper_owner:again/2,
    typhon_options:declared/4,
    typhon_starting:ends/2,
    typhon_starting:delivers/3,
    typhon_program_words:python_undelivered/2,
    prolog:error_message//1.

:- dynamic
    started/2,                  % Host, Options
    loaded/3.                   % Host, Name, Request: loads the module Name

load_seconds(30).

typhon_starting:starts(python, Host, Files, Options) :-
    check_options(python_option, Options),
    (   is_list(Files)
    ->  maplist(python_file, Files, Loads)
    ;   python_file(Files, Load),
        Loads = [Load]
    ),
    service_begin(python, Host, [], typhon_python,
                  ( python_open(Host, Options),
                    load_all(Loads, Host) )).

python_file(Spec, _{do:load, name:Name, file:File}) :-
    absolute_file_name(Spec, File, [extensions([py,'']), access(read)]),
    file_base_name(File, Base),
    file_name_extension(Name, _, Base).

load_all(Loads, Host) :-
    maplist(python_load(Host), Loads, PIs, Clauses),
    append(PIs, AllPIs),
    append(Clauses, AllClauses),
    service_offer(service(python), Host, AllPIs, AllClauses).

typhon_options:declared(python_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(timeout(X), between(0.001, 3600), X).
option_type(threads(X), between(1, 1000), X).
option_type(queue(X), positive_integer, X).
option_type(python(X), atom, X).

%   python_open(+Host, +Options) is det.
%
%   Start Python, without functions yet.

python_open(Host, Options) :-
    assertz(started(Host, Options)),
    helper_python(Options, Python),
    helper_file('python/bridge.py', File),
    option(threads(Threads), Options, 8),
    helper_open(python(Host),
                command(Python, ['-u', File, '--threads', Threads]),
                [restart(always)]).

%   python_load(+Host, +Request, -PIs:list, -Clauses:list) is det.
%
%   Load a module into Python, now and after each restart; Clauses call its
%   functions.
%
%   @error the errors of python_ask/4

python_load(Host, Request, PIs, Clauses) :-
    load_seconds(Seconds),
    python_ask(Host, Request, Seconds, Functions),
    Name = Request.name,
    retractall(loaded(Host, Name, _)),
    assertz(loaded(Host, Name, Request)),
    python_functions(Name, Functions, PIs, Clauses).

%   python_forget(+Host, +Name) is det.
%
%   Remove the module Name from the Python process.

python_forget(Host, Name) :-
    retractall(loaded(Host, Name, _)),
    helper_note(python(Host), _{do:drop, name:Name}).

typhon_helper_owner:again(python(Host), Request) :-
    loaded(Host, _, Request).

seconds(Host, Seconds) :-
    started(Host, Options),
    option(timeout(Seconds), Options, 10).

typhon_starting:ends(python, Host) :-
    helper_close(python(Host)),
    retractall(started(Host, _)),
    retractall(loaded(Host, _, _)).

typhon_helper_owner:handle_message(python(Host), Dict) :-
    get_dict(event, Dict, Event),
    handle_event(Event, Host, Dict).

handle_event("post", Host, Dict) :-
    get_dict(to, Dict, Text),
    get_dict(message, Dict, Message),
    atom_string(Agent, Text),
    started(Host, Options),
    option(queue(Max), Options, 1000),
    inbox_put(how(message, Max), python-posts, Host-Agent, Message-_).
handle_event("leave", Host, Dict) :-
    get_dict(fact, Dict, Fact),
    started(Host, Options),
    option(queue(Max), Options, 1000),
    inbox_put(how(fact, Max), python-facts, Host-none, Fact-_).

typhon_starting:delivers(Host, Name, Source) :-
    with_mutex(typhon_python, begun(Host)),
    module_name(Name, Module),
    python_load(Host, _{do:load, name:Module, source:Source}, PIs, Clauses),
    service_offer(Name, Host, PIs, Clauses).

begun(Host) :-
    (   service(python, Host)
    ->  true
    ;   service_begin(python, Host, [], typhon_python, python_open(Host, []))
    ).

typhon_program_words:python_undelivered(Host, Name) :-
    service(python, Host),
    module_name(Name, Module),
    python_forget(Host, Module).

%   No file has such a name, so a payload replaces no module of a file.

module_name(Name, Module) :-
    atom_concat('payload ', Name, Module).

                /*******************************
                *            CALLS             *
                *******************************/

%   python_functions(+Module, +Functions, -PIs:list, -Clauses:list) is det.
%
%   Clauses call the Functions of a Python module, in the form of the answer to
%   `load` in bridges/python/bridge.py.  Each number of arguments gives a
%   predicate, with the result as one more argument.

python_functions(Module, Functions, PIs, Clauses) :-
    findall(Name/Arity-Clause,
            ( member(Function, Functions),
              function(Module, Function, Name/Arity, Clause) ),
            Pairs),
    pairs_keys_values(Pairs, PIs, Clauses).

function(Module, Function, Name/Arity, Clause) :-
    get_dict(name, Function, Text),
    atom_string(Name, Text),
    get_dict(least, Function, Least),
    get_dict(most, Function, Most),
    between(Least, Most, N),
    Arity is N+1,
    functor(Head, Name, Arity),
    Head =.. [_|All],
    append(Args, [Result], All),
    Clause = (Head :- typhon_python_service:run(Module, Name, Args, Result)).

%   run(+Module, +Function, +Args, -Result): runs on the host of the agent, or
%   in remote/2.

:- public run/4.

run(Module, Function, Args, Result) :-
    subscriber(Host, Agent),
    (   seconds(Host, Seconds)
    ->  true
    ;   existence_error(python, Host)   % the service was stopped
    ),
    agent_value(Agent, Caller),
    python_ask(Host,
               _{ do:call, module:Module, function:Function, args:Args,
                  agent:Caller },
               Seconds, Result0),
    Result = Result0.

agent_value(none, null) :-
    !.
agent_value(Agent, Agent).

%   python_ask(+Host, +Request, +Seconds, -Reply) is det.
%
%   @error python_error(Class, Message) Python has raised an exception
%   @error timeout_error(python(What), Host)
%   @error helper_died(Status, python(Host))
%   @error existence_error(helper, python(Host))

python_ask(Host, Request, Seconds, Reply) :-
    helper_call(python(Host), Request, Seconds, failure(Host, Request), Reply).

failure(Host, Request, said(Dict), error(Formal, context(_, _))) :-
    get_dict(error, Dict, Kind),
    formal(Kind, Dict, Host, Request, Formal).

formal("exception", Dict, _, _, python_error(Class, Message)) :-
    _{class:Text, message:Message} :< Dict,
    atom_string(Class, Text).
formal("no_json", Dict, _, _, python_error('ValueError', Message)) :-
    get_dict(message, Dict, Message).
formal("timeout", _, Host, Request, timeout_error(python(What), Host)) :-
    (   get_dict(function, Request, Function)
    ->  What = Function
    ;   get_dict(do, Request, What)
    ).
