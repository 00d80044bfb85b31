:- module(typhon_outcomes,
          [ results_keep/2,             % +Id, +Items
            results_ask/4,              % +Where, +Id, +Kind, -Items
            clone_born/2,               % +Parent, +Clone
            clone_unborn/2,             % +Parent, +Clone
            clones_ask/3                % +Endpoint, +Parent, -Clones
          ]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable',
              [ durable/5, durable/6, durable_assertz/1, durable_drop_all/2,
                durable_retractall/1 ]).
:- use_module('../wire', [endpoint_address/1, endpoint_reply/2]).
:- use_module('../host', [process_ask/6]).
:- use_module('../agent', [agent/5, cloned_put/2]).

/** <module> Results of ended agents, and their clones

The home of an agent keeps its results with its outcome: the result, and the
processes in which the agent was cloned.  The clones themselves are recorded in
the process in which they were born, which is their home.  So no notice is sent
when a clone is made, and a search for all clones goes from the results of an
agent to the homes of its clones, and so on.  The oldest entries of both tables
are discarded.

*Threading*: any thread.  results_ask/4 and clones_ask/3 wait for the answer.
*/

:- multifile
    typhon_bounds:forgotten/1,
    typhon_identity:ids_anew/0,
    typhon_identity:id_anew/1,
    typhon_endpoint:requested/4.

:- setting(results, positive_integer, 20000,
           "Results of ended agents, kept by their home").
:- setting(clones, positive_integer, 20000,
           "Clones of which their home knows the parent").

:- dynamic
    left/2,                     % Id, Item
    clone_of/2.                 % Parent, Clone: it was born here

typhon_identity:ids_anew :-
    retractall(left(_, _)),
    retractall(clone_of(_, _)).
typhon_identity:id_anew(Id) :-
    retractall(left(Id, _)),
    retractall(clone_of(Id, _)).

%!  results_keep(+Id, +Items:list) is det.
%
%   Record Items, as in result_facts/2, of Id, which has ended.

results_keep(Id, Items) :-
    forall(member(Item, Items),
           bounded(left(_, _), typhon_outcomes:results,
                   durable_assertz(left(Id, Item)))).

%!  results_ask(+Where, +Id, +Kind, -Items:list) is det.
%
%   Items are the results of Id of the name Kind in the process at the endpoint
%   Where, the home of Id, or `here`.
%
%   @error host_unreachable(Where), connection_lost(Where)

results_ask(Where, Id, Kind, Items) :-
    ask(Where, left(Id, Kind), Items).

typhon_bounds:forgotten(left(Id, _)) :-
    durable_drop_all(left, Id).
typhon_bounds:forgotten(clone_of(_, Clone)) :-
    durable_drop_all(clone, Clone).

:- durable(left, Id, _, Item, left(Id, Item)).
:- durable(clone, Clone, _, Parent, clone_of(Parent, Clone)).
:- durable(flag, Name, N, '',
           ( member(Name, [results, clones]), flag(Name, N, N) ),
           set_flag(Name, N)).

%!  clone_born(+Parent, +Clone) is det.
%
%   Record Clone, a clone of Parent, which is here.

clone_born(Parent, Clone) :-
    bounded(clone_of(_, _), typhon_outcomes:clones,
            durable_assertz(clone_of(Parent, Clone))),
    (   endpoint_address(Endpoint),
        agent(Parent, _, Module, _, _)
    ->  cloned_put(Module, Endpoint)
    ;   true                            % the process is stopping
    ).

%!  clone_unborn(+Parent, +Clone) is det.
%
%   Remove the record: Clone could not begin in another process.

clone_unborn(Parent, Clone) :-
    durable_retractall(clone_of(Parent, Clone)).

%!  clones_ask(+Endpoint, +Parent, -Clones:list) is det.
%
%   Clones are the clones of Parent born at Endpoint, in the order of their
%   birth.
%
%   @error as results_ask/4

clones_ask(Endpoint, Parent, Clones) :-
    ask(Endpoint, clones(Parent), Clones).

%   After the last host was stopped there is no endpoint; no process is asked
%   for clones that are recorded here.

ask(Where, Question, Answer) :-
    (   Where == here
    ;   endpoint_address(Where)
    ;   asked_here(Question)
    ),
    !,
    known(Question, Answer).
ask(Endpoint, Question, Answer) :-
    process_ask(Endpoint, Endpoint, results, Question, Answer, 10).

asked_here(clones(Parent)) :-
    \+ endpoint_address(_),
    clone_of(Parent, _).

typhon_endpoint:requested(results, Question, _Peer, ReplyTo) :-
    known(Question, Answer),
    endpoint_reply(ReplyTo, Answer).

%   list_to_set/2 removes duplicates, because 9.0.4 may yield a fact twice while
%   other threads add facts.

known(left(Id, Kind), Items) :-
    functor(Item, Kind, 1),
    findall(Item, left(Id, Item), Items).
known(clones(Parent), Clones) :-
    findall(Clone, clone_of(Parent, Clone), Clones0),
    list_to_set(Clones0, Clones).
