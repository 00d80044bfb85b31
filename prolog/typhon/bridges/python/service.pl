:- module(typhon_python_service,
          [ python_begin/2,             % +Host, +Options
            python_load/4,              % +Host, +Request, -PIs, -Clauses
            python_forget/2             % +Host, +Name
          ]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists), [append/2]).
:- use_module(library(option), [option/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../helper',
              [ helper_close/1, helper_file/2, helper_note/2, helper_open/3,
                helper_python/2 ]).
:- use_module('../common',
              [ inbox_put/4, service_begin/4, service_end/2, service_offer/4 ]).
:- use_module(calls, [python_ask/4, python_functions/4]).

/** <module> Python on a host

*Threading*: any thread.  What Python says unasked is passed on by the thread
that reads it.
*/

:- multifile
    typhon_starting:starts/4,
    typhon_helper_answers:heard/2,
    typhon_helper_owner:again/2,
    typhon_options:declared/4,
    typhon_python_calls:seconds/2,
    typhon_services:ends/2.

:- dynamic
    started/2,                  % Host, Options
    loaded/3.                   % Host, Name, Request: the modules

load_seconds(30).

typhon_starting:starts(python, Host, Files, Options) :-
    check_options(python_option, Options),
    (   is_list(Files)
    ->  maplist(python_file, Files, Loads)
    ;   python_file(Files, Load),
        Loads = [Load]
    ),
    python_begin(Host, Options),
    catch(load_all(Loads, Host), Ball,
          ( service_end(python, Host),
            throw(Ball) )).

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

%!  python_begin(+Host, +Options) is det.
%
%   Python without functions yet.

python_begin(Host, Options) :-
    service_begin(python, Host, [], typhon_python),
    assertz(started(Host, Options)),
    helper_python(Options, Python),
    helper_file('python/bridge.py', File),
    option(threads(Threads), Options, 8),
    helper_open(python(Host),
                command(Python, ['-u', File, '--threads', Threads]),
                [restart(always)]).

%!  python_load(+Host, +Request, -PIs:list, -Clauses:list) is det.
%
%   Python gets a module, now and when it is started again; Clauses call its
%   functions.
%
%   @error those of python_ask/4

python_load(Host, Request, PIs, Clauses) :-
    load_seconds(Seconds),
    python_ask(Host, Request, Seconds, Functions),
    Name = Request.name,
    retractall(loaded(Host, Name, _)),
    assertz(loaded(Host, Name, Request)),
    python_functions(Name, Functions, PIs, Clauses).

%!  python_forget(+Host, +Name) is det.
%
%   Python needs the module Name no longer.

python_forget(Host, Name) :-
    retractall(loaded(Host, Name, _)),
    helper_note(python(Host), _{do:drop, name:Name}).

typhon_helper_owner:again(python(Host), Request) :-
    loaded(Host, _, Request).

typhon_python_calls:seconds(Host, Seconds) :-
    started(Host, Options),
    option(timeout(Seconds), Options, 10).

typhon_services:ends(python, Host) :-
    ignore(catch(helper_close(python(Host)),
                 error(existence_error(_, _), _), true)),
    retractall(started(Host, _)),
    retractall(loaded(Host, _, _)).

                /*******************************
                *       WHAT PYTHON SAYS       *
                *******************************/

typhon_helper_answers:heard(python(Host), Dict) :-
    get_dict(event, Dict, Event),
    heard(Event, Host, Dict).

heard("post", Host, Dict) :-
    get_dict(to, Dict, Text),
    get_dict(message, Dict, Message),
    atom_string(Agent, Text),
    started(Host, Options),
    option(queue(Max), Options, 1000),
    inbox_put(how(message, Max), python-posts, Host-Agent, Message-_).
heard("leave", Host, Dict) :-
    get_dict(fact, Dict, Fact),
    started(Host, Options),
    option(queue(Max), Options, 1000),
    inbox_put(how(fact, Max), python-facts, Host-none, Fact-_).
