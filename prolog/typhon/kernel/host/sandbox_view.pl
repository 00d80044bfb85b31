:- module(typhon_sandbox_view,
          [ service/1,                  % +PIs
            front_gone/1,               % +Place
            place_front/3,              % +Place, -Front, -Policy
            guarding/0,
            module_policy/2             % +Module, -Policy
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(option), [option/3]).
:- use_module('../program', [indicator_in/2, policy_read/1]).
:- use_module(hosts, [host/3]).

/** <module> What strangers see of a place

Agents on a host that guards do not hang below its place but below its front,
a module with nothing but what the place offers by directives

    :- service(p/1).

in files consulted into it.  See typhon_guard.

*Threading*: front_gone/1 as host_start/2; the others in any thread.
*/

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2.

:- dynamic
    offered/2,                  % Place, PI
    front/3,                    % Place, Front, Policy: that of now first
    made/2,                     % Place, Front
    guards/2,                   % Front, Policy
    guarding/0.

%!  service(+PIs) is det.
%
%   A directive in a file that is consulted into a place: agents of strangers
%   may call PIs, too, predicates like p/1 with commas between.

service(PIs) :-
    prolog_load_context(module, Place),
    forall(indicator_in(PIs, PI), offer(Place, PI)).

offer(Place, PI) :-
    offered(Place, PI),
    !.
offer(Place, PI) :-
    must_be(ground, PI),
    assertz(offered(Place, PI)),
    (   front(Place, Front, _)
    ->  show(Place, Front, PI)
    ;   true
    ).

typhon_host_parts:begins(Host, Place, Options) :-
    option(policy(Policy), Options, trusted),
    front_set(Host, Place, Policy).

typhon_host_parts:changeable(policy(_)).

%   Before the option is put: so a file of rules that is wrong changes nothing.

typhon_host_parts:changes(policy(Policy), Host) :-
    host(Host, _, Place),
    front_set(Host, Place, Policy).

%   front_set(+Host, +Place, +Policy)
%
%   Policy is `trusted`, `guarded`, or a file of rules.  Agents on the host
%   keep their policy.
%
%   @error what policy_read/1 raises

front_set(_, Place, trusted) :-
    !,
    retractall(front(Place, _, _)).
front_set(Host, Place, Policy) :-
    policy_read(Policy),
    flag(typhon_sandbox_view, N, N+1),
    atomic_list_concat(['front ', Host, ' ', N], Front),
    set_module(Front:class(temporary)),
    set_module(Front:base(typhon_vocabulary)),
    forall(offered(Place, PI), show(Place, Front, PI)),
    assertz(made(Place, Front)),
    ( guarding -> true ; assertz(guarding) ),
    assertz(guards(Front, Policy)),
    asserta(front(Place, Front, Policy)).

show(Place, Front, PI) :-
    export(Place:PI),
    @(import(Place:PI), Front).

%!  front_gone(+Place) is det.

front_gone(Place) :-
    retractall(offered(Place, _)),
    retractall(front(Place, _, _)),
    fronts_gone(Place),
    ( guards(_, _) -> true ; retractall(guarding) ).

fronts_gone(Place) :-
    (   retract(made(Place, Front))
    ->  retractall(guards(Front, _)),
        '$destroy_module'(Front),
        fronts_gone(Place)
    ;   true
    ).

%!  place_front(+Place, -Front, -Policy) is semidet.
%
%   Fails for places that all agents may see.

place_front(Place, Front, Policy) :-
    front(Place, Front0, Policy0),
    !,
    Front = Front0,
    Policy = Policy0.

%!  guarding is semidet.
%
%   A host of this process guards, or has done so: what hops ask first.

%!  module_policy(+Module, -Policy) is semidet.
%
%   Module is that of an agent which hangs below a front.

module_policy(Module, Policy) :-
    guarding,
    import_module(Module, Front),
    guards(Front, Policy),
    !.
