:- module(typhon_drain,
          [ drain_host/2                % +Host, +Options
          ]).
:- use_module(library(error),
              [existence_error/2, resource_error/1]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(thread), [concurrent_forall/3]).
:- use_module('../../kernel/agent', [agent_here/5]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/host', [host/3, host_resolve/2]).
:- use_module('../../kernel/lifecycle', [agent_move/3]).
:- use_module(members, [fleet_host/3, fleet_told/1]).
:- use_module(tags, [choices_forget/1, hosts_of_fleet/3]).

/** <module> A host that is drained: its agents go elsewhere, and it leaves

*Threading*: any thread that may wait.
*/

:- multifile
    prolog:message//1,
    typhon_host_parts:ends/1,
    typhon_members:tags_hidden/1,
    typhon_members:is_gone/1,
    typhon_options:declared/4.

:- dynamic
    draining/1,                 % Host: nothing chooses it
    drained/1.                  % Host: it has left its fleet

typhon_options:declared(drain_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(to(X), list(atom), X).
option_type(to(X), atom, X).
option_type(seconds(X), number, X).
option_type(stay(X), any, X).

typhon_members:tags_hidden(Host) :-
    draining(Host).
typhon_members:is_gone(Host) :-
    drained(Host).

typhon_host_parts:ends(Host) :-
    retractall(draining(Host)),
    retractall(drained(Host)).

%!  drain_host(+Host, +Options) is det.
%
%   See fleet_drain/2.

drain_host(Host, Options) :-
    check_options(drain_option, Options),
    host_resolve(Host, Where),
    (   Where = local(Name)
    ->  true
    ;   existence_error(host, Host)
    ),
    (   fleet_host(Name, Fleet, Tags)
    ->  true
    ;   existence_error(fleet_of_host, Name)
    ),
    targets(Options, Tags, To),
    others(Fleet, To, Name, _),
    assertz(draining(Name)),
    catch(drain(Fleet, Name, To, Options, Stay), Ball,
          ( retractall(draining(Name)), throw(Ball) )),
    (   option(stay(Stay0), Options)
    ->  Stay0 = Stay
    ;   Stay == []
    ->  true
    ;   print_message(warning, typhon(fleet_drained(Name, Stay)))
    ).

targets(Options, Tags, To) :-
    (   option(to(To0), Options)
    ->  To = To0
    ;   Tags = [To|_]
    ->  true
    ;   To = []
    ).

others(Fleet, To, Name, Others) :-
    host(Name, Address, _),
    hosts_of_fleet(Fleet, Hosts, [tag(To), state(up)]),
    findall(Host, ( member(Host, Hosts), Host \== Address ), Others),
    (   Others == []
    ->  resource_error(hosts(To))
    ;   true
    ).

%   Agents that arrive meanwhile leave, too; what did not go in time stays.

drain(Fleet, Name, To, Options, Stay) :-
    ignore(fleet_told(Fleet)),
    choices_forget(Fleet),
    option(seconds(Seconds), Options, 60),
    deadline(Seconds, Deadline),
    all_leave(Fleet, Name, To, Deadline, [], Stay),
    assertz(drained(Name)),
    ignore(fleet_told(Fleet)).

all_leave(Fleet, Name, To, Deadline, Tried, Stay) :-
    findall(Id, ( agent_here(Id, Name, _, _, _), \+ memberchk(Id, Tried) ), Ids),
    monotonic_time(Now),
    Left is Deadline-Now,
    (   ( Ids == [] ; Left =< 0 )
    ->  findall(Id, agent_here(Id, Name, _, _, _), Stay)
    ;   others(Fleet, To, Name, Others),
        spread(Ids, Others, Others, Moves),
        concurrent_forall(member(Id-Host, Moves),
                          typhon_drain:leaves(Id, Host, Left),
                          [threads(8)]),
        append(Ids, Tried, Tried1),
        all_leave(Fleet, Name, To, Deadline, Tried1, Stay)
    ).

spread([], _, _, []).
spread(Ids, [], All, Moves) :-
    Ids = [_|_],
    spread(Ids, All, All, Moves).
spread([Id|Ids], [Host|Hosts], All, [Id-Host|Moves]) :-
    spread(Ids, Hosts, All, Moves).

leaves(Id, Host, Seconds) :-
    catch(agent_move(Id, Host, [wait(Seconds)]), error(_, _), true).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:message(typhon(fleet_drained(Host, Stay))) -->
    { length(Stay, Count) },
    [ 'Agents that stay on the host ~w, which is drained: ~d'-[Host, Count] ],
    each(Stay).

each([]) -->
    [].
each([Id|Ids]) -->
    [ nl, '  ~w'-[Id] ],
    each(Ids).
