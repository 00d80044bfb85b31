:- module(typhon_python_calls,
          [ python_functions/4,         % +Module, +Functions, -PIs, -Clauses
            python_ask/4                % +Host, +Request, +Seconds, -Reply
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module('../helper', [helper_ask/4, helper_failure/3]).
:- use_module('../common', [json_value/1, subscriber/2]).

/** <module> Calls of Python functions

*Threading*: any thread; it waits for the answer, others do not.
*/

:- multifile
    seconds/2,                  % Host, Seconds: how long a call may take
    prolog:error_message//1.

%!  python_functions(+Module, +Functions, -PIs:list, -Clauses:list) is det.
%
%   The clauses by which functions of a Python module are called, as `load` of
%   bridges/python/bridge.py tells them: a predicate for each number of
%   arguments, the result being one more.

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
    Clause = (Head :- typhon_python_calls:run(Module, Name, Args, Result)).

%   run(+Module, +Function, +Args, -Result): where an agent stands, or in
%   remote/2.

:- public run/4.

run(Module, Function, Args, Result) :-
    subscriber(Host, Agent),
    maplist(json_value, Args),
    (   seconds(Host, Seconds)
    ->  true
    ;   existence_error(python, Host)   % it was stopped
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

%!  python_ask(+Host, +Request, +Seconds, -Reply) is det.
%
%   @error python_error(Class, Message) what Python has raised
%   @error timeout_error(python(What), Host)
%   @error helper_died(Status, python(Host))
%   @error existence_error(helper, python(Host))

python_ask(Host, Request, Seconds, Reply) :-
    helper_ask(python(Host), Request, Seconds, Answer),
    (   Answer = ok(Reply0)
    ->  Reply = Reply0
    ;   failure(Answer, Host, Request)
    ).

failure(said(Dict), _, _) :-
    get_dict(error, Dict, Kind),
    python_error(Kind, Dict, Class),
    !,
    get_dict(message, Dict, Message),
    throw(error(python_error(Class, Message), context(_, _))).
failure(said(Dict), Host, Request) :-
    get_dict(error, Dict, "timeout"),
    !,
    what(Request, What),
    throw(error(timeout_error(python(What), Host), context(_, _))).
failure(Answer, Host, Request) :-
    what(Request, What),
    helper_failure(Answer, python(Host), What).

python_error("exception", Dict, Class) :-
    get_dict(class, Dict, Text),
    atom_string(Class, Text).
python_error("no_json", _, 'ValueError').

what(Request, What) :-
    (   get_dict(function, Request, Function)
    ->  What = Function
    ;   get_dict(do, Request, What)
    ).

prolog:error_message(python_error(Class, Message)) -->
    [ 'Python: ~w: ~w'-[Class, Message] ].
prolog:error_message(timeout_error(python(What), Host)) -->
    [ 'Python on ~w has not done ~w in time'-[Host, What] ].
