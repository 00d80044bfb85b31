:- module(typhon_life,
          [ is_life/1,                  % @Term
            make_life/5,                % +Lifetime, +Tokens, +Payloads,
                                        % +Static, -Life
            life_parent/2,              % +Life, -Id
            life_hops/2,                % +Life, -Count
            life_tokens/2,              % +Life, -Tokens
            life_payloads/2,            % +Life, -Payloads
            life_extras/2,              % +Life, -Extras
            life_carried/2,             % +Life, +Id
            agent_extras_missing/1,     % @Life
            agent_extras_load/1,        % +Life
            set_payloads_of_life/3,     % +Payloads, +Life0, -Life
            set_extras_of_life/3,       % +Extras, +Life0, -Life
            life_may_move/2,            % +Life, -May
            life_hop/3,                 % +Life0, -Life, -Hops
            life_goes/3,                % +Life0, -Life, -Hops
            life_came/2,                % @Life, -Hops
            life_before/2,              % +Life, -Life0
            life_clone/3                % +Id, +Life0, -Life
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/on_demand', [on_demand_load/2, on_demand_missing/2]).

/** <module> The life of an agent: data that it carries besides its state

A life is

    life(Parent, Hops, Lifetime, Tokens, Payloads, Static, Extras)

the agent of which it is a clone or `none`, the number of its hops, the number
of hops after which it ends or `inf`, the tokens that it shows to hosts that
require one, a list of Name-PIs, whether it must not move, and a list of terms
that options let it carry.  A life goes over the wire and into restore points as
it is; only this module accesses its arguments.

*Threading*: pure, except life_carried/2 and agent_extras_load/1, which load
code.
*/

:- multifile
    not_cloned/1,               % Extra: a clone does not carry it
    carries/3.                  % Name, Id, Extra: the agent is in this process
                                % now, and carries Extra, of functor name Name

%!  is_life(@Term) is semidet.
%
%   Term is a life, with arguments of the right types.

is_life(life(Parent, Hops, Lifetime, Tokens, Payloads, Static, Extras)) :-
    atom(Parent),
    integer(Hops),
    atomic(Lifetime),
    is_list(Tokens),
    is_list(Payloads),
    all_carried(Payloads),
    atom(Static),
    is_list(Extras).

%   A life from another process could name predicates of other modules, which
%   would be abolished when the payload is detached.

all_carried([]).
all_carried([Payload|Payloads]) :-
    nonvar(Payload),
    Payload = Name-PIs,
    atom(Name),
    is_list(PIs),
    forall(member(PI, PIs), is_indicator(PI)),
    all_carried(Payloads).

is_indicator(PI) :-
    nonvar(PI),
    PI = Name/Arity,
    atom(Name),
    integer(Arity).

%!  make_life(+Lifetime, +Tokens:list, +Payloads:list, +Static:boolean,
%!            -Life) is det.
%
%   Life is the life of a new agent that is no clone.

make_life(Lifetime, Tokens, Payloads, Static,
          life(none, 0, Lifetime, Tokens, Payloads, Static, [])).

%!  life_parent(+Life, -Id) is det.
%!  life_hops(+Life, -Count:integer) is det.
%!  life_tokens(+Life, -Tokens:list) is det.
%!  life_payloads(+Life, -Payloads:list) is det.
%!  life_extras(+Life, -Extras:list) is det.

life_parent(life(Parent, _, _, _, _, _, _), Parent).
life_hops(life(_, Hops, _, _, _, _, _), Hops).
life_tokens(life(_, _, _, Tokens, _, _, _), Tokens).
life_payloads(life(_, _, _, _, Payloads, _, _), Payloads).
life_extras(life(_, _, _, _, _, _, Extras), Extras).

%!  set_payloads_of_life(+Payloads:list, +Life0, -Life) is det.
%!  set_extras_of_life(+Extras:list, +Life0, -Life) is det.

set_payloads_of_life(Payloads, life(P, H, L, T, _, S, E),
                     life(P, H, L, T, Payloads, S, E)).

set_extras_of_life(Extras, life(P, H, L, T, Ps, S, _),
                   life(P, H, L, T, Ps, S, Extras)).

%!  life_may_move(+Life, -May) is det.
%
%   May is `go`, `static` if it must not move, or `end` if it has made all its
%   hops.

life_may_move(life(_, Hops, Most, _, _, Static, _), May) :-
    (   Static == true
    ->  May = static
    ;   integer(Most),
        Hops >= Most
    ->  May = end
    ;   May = go
    ).

%!  life_hop(+Life0, -Life, -Hops:integer) is det.
%
%   Life is Life0 with one more hop, number Hops.

life_hop(life(Parent, Hops0, Most, Tokens, Payloads, Static, Extras),
         life(Parent, Hops, Most, Tokens, Payloads, Static, Extras), Hops) :-
    Hops is Hops0+1.

%!  life_goes(+Life0, -Life, -Hops:integer) is semidet.
%
%   As life_hop/3, for an agent that may move and carries no extras.

life_goes(life(Parent, Hops0, Most, Tokens, Payloads, false, []),
          life(Parent, Hops, Most, Tokens, Payloads, false, []), Hops) :-
    (   Most == inf
    ->  true
    ;   integer(Most),
        Hops0 < Most
    ),
    Hops is Hops0+1.

%!  life_came(@Life, -Hops:integer) is semidet.
%
%   Life, any term, is that of an agent that has made Hops hops and carries no
%   extras.

life_came(Life, Hops) :-
    is_life(Life),
    Life = life(_, Hops, _, _, _, _, []).

%!  life_before(+Life, -Life0) is det.
%
%   Life0 is Life before its last hop.

life_before(life(Parent, Hops, Most, Tokens, Payloads, Static, Extras),
            life(Parent, Hops0, Most, Tokens, Payloads, Static, Extras)) :-
    Hops0 is Hops-1.

%!  life_clone(+Id, +Life0, -Life) is det.
%
%   Life is the life of a clone of Id, whose life is Life0.

life_clone(Id, life(_, _, Most, Tokens, Payloads, Static, Extras0),
           life(Id, 0, Most, Tokens, Payloads, Static, Extras)) :-
    exclude(not_cloned, Extras0, Extras).

%!  life_carried(+Life, +Id) is det.
%
%   The agent Id, with this Life, is in this process now: pass the extras that
%   it carries to their options.

life_carried(Life, Id) :-
    life_extras(Life, Extras),
    (   Extras == []
    ->  true
    ;   forall(extra(Life, Name, Extra),
               ( on_demand_load(carries, Name),
                 ignore(carries(Name, Id, Extra)) ))
    ).

%!  agent_extras_missing(@Life) is semidet.
%
%   Life, any term, has an extra whose option is not loaded.

agent_extras_missing(Life) :-
    is_life(Life),
    extra(Life, Name, _),
    on_demand_missing(carries, Name),
    !.

%!  agent_extras_load(+Life) is det.
%
%   Load the options of all extras.  Not for the thread of a connection.

agent_extras_load(Life) :-
    forall(extra(Life, Name, _), on_demand_load(carries, Name)).

%   extra(+Life, ?Name, -Extra) is nondet: Life has Extra, of functor name Name.
%   Extras may come from a peer, so they may be any terms.

extra(Life, Name, Extra) :-
    life_extras(Life, Extras),
    member(Extra, Extras),
    callable(Extra),
    functor(Extra, Name, _).
