:- module(typhon_life,
          [ is_life/1,                  % @Term
            make_life/2,                % +Fields, -Life
            life_parent/2,              % +Life, -Id
            life_hops/2,                % +Life, -Count
            life_tokens/2,              % +Life, -Tokens
            life_payloads/2,            % +Life, -Payloads
            life_extras/2,              % +Life, -Extras
            set_payloads_of_life/3,     % +Payloads, +Life0, -Life
            set_extras_of_life/3,       % +Extras, +Life0, -Life
            life_may_move/2,            % +Life, -May
            life_hop/3,                 % +Life0, -Life, -Hops
            life_before/2,              % +Life, -Life0
            life_clone/3                % +Id, +Life0, -Life
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(record), [(record)/1, op(_, _, record)]).

/** <module> What an agent takes along besides its state

A life is

    life(Parent, Hops, Lifetime, Tokens, Payloads, Static, Extras)

the agent of which it is a clone or `none`, how often it moved, after how
many hops it ends or `inf`, what it shows to hosts that ask for a token, a
list of Name-PIs, whether it may not move, and a list of what options let it
carry.  It goes over the wire and into restore points as it is; no other module
takes it apart.

*Threading*: pure.
*/

:- multifile error:has_type/2.

%   A life that comes from another process could name predicates of a module,
%   which would go when the payload is detached.

error:has_type(typhon_carried_payloads, Payloads) :-
    is_list(Payloads),
    all_carried(Payloads).

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

:- record life(parent:atom=none, hops:integer=0, lifetime:atomic=inf,
               tokens:list=[], payloads:typhon_carried_payloads=[],
               static:atom=false, extras:list=[]).

:- multifile
    not_cloned/1.               % Extra: a clone does not carry it

:- dynamic not_cloned/1.

%!  is_life(@Term) is semidet.
%!  make_life(+Fields:list, -Life) is det.
%!  life_parent(+Life, -Id) is det.
%!  life_hops(+Life, -Count:integer) is det.
%!  life_tokens(+Life, -Tokens:list) is det.
%!  life_payloads(+Life, -Payloads:list) is det.
%!  life_extras(+Life, -Extras:list) is det.
%!  set_payloads_of_life(+Payloads:list, +Life0, -Life) is det.
%!  set_extras_of_life(+Extras:list, +Life0, -Life) is det.
%
%   See library(record).

%!  life_may_move(+Life, -May) is det.
%
%   May is `go`, `static` if it never may, or `end`: it has made all its hops.

life_may_move(life(_, _, inf, _, _, false, _), May) :-
    !,
    May = go.                           % nearly always
life_may_move(Life, May) :-
    (   life_static(Life, true)
    ->  May = static
    ;   life_lifetime(Life, Most),
        integer(Most),
        life_hops(Life, Hops),
        Hops >= Most
    ->  May = end
    ;   May = go
    ).

%!  life_hop(+Life0, -Life, -Hops:integer) is det.
%
%   One hop more, which makes Hops.

life_hop(life(Parent, Hops0, Most, Tokens, Payloads, Static, Extras),
         life(Parent, Hops, Most, Tokens, Payloads, Static, Extras), Hops) :-
    Hops is Hops0+1.

%!  life_before(+Life, -Life0) is det.
%
%   Life0 is Life before its last hop.

life_before(life(Parent, Hops, Most, Tokens, Payloads, Static, Extras),
            life(Parent, Hops0, Most, Tokens, Payloads, Static, Extras)) :-
    Hops0 is Hops-1.

%!  life_clone(+Id, +Life0, -Life) is det.
%
%   Life0 is that of Id, Life that of a clone of it.

life_clone(Id, Life0, Life) :-
    set_parent_of_life(Id, Life0, Life1),
    set_hops_of_life(0, Life1, Life2),
    life_extras(Life0, Extras0),
    exclude(not_cloned, Extras0, Extras),
    set_extras_of_life(Extras, Life2, Life).
