:- module(typhon_time_quota,
          [ stay_begins/4,              % +Id, +Host, +Module, +Hash
            stay_ends/1,                % +Id
            stay_owner/3,               % ?Id, +Host, -Owner
            stay_count/3,               % +Host, +Owner, -Count
            stay_until/3                % +Id, ?Host, -Until
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module('../host',
              [ alarm_set/3, host_time/2, quota/3, quota_any/1, real_time/3 ]).
:- use_module(state_text, [state_text_forget/1]).
:- use_module(identity, [agent_origin/5, origin_key/2]).

/** <module> Agents on a host with quotas

While an agent stands there: whose it is, and how long it may.

*Threading*: begins and ends inside with_agent/2 of the agent; anybody asks.
*/

:- multifile typhon_rate_limits:owner/3.

:- dynamic stays/4.             % Id, Host, Owner: an atom, Until or inf

%!  stay_begins(+Id, +Host, +Module, +Hash) is det.
%!  stay_ends(+Id) is det.
%
%   Id stands on Host from now on, with its state in Module and the program
%   Hash; it does no longer.

stay_begins(Id, Host, Module, Hash) :-
    stay_ends(Id),
    (   quota_any(_)
    ->  begins(Id, Host, Module, Hash)
    ;   true
    ).

begins(Id, Host, Module, Hash) :-
    space(Host, Module),
    (   quota_any(Host),
        agent_origin(Host, Id, Hash, module(Module), Owner)
    ->  origin_key(Owner, Key),
        until(Host, Until),
        assertz(stays(Id, Host, Key, Until)),
        ends_at(Until, Host, Id)
    ;   true
    ).

%   Its module comes from a host that may have had another quota.

space(Host, Module) :-
    (   quota(Host, state, Most)
    ->  module_property(Module, program_size(Size)),
        Space is max(integer(Most), Size),
        set_module(Module:program_space(Space))
    ;   set_module(Module:program_space(0))
    ).

until(Host, Until) :-
    quota(Host, lifetime, Seconds),
    host_time(Host, Now),
    !,
    Until is Now+Seconds.
until(_, inf).

ends_at(inf, _, _) :-
    !.
ends_at(Until, Host, Id) :-
    real_time(Host, Until, Stamp),
    alarm_set(Stamp, Id, stays(Until)).

stay_ends(Id) :-
    (   stays(Id, _, _, _)
    ->  retractall(stays(Id, _, _, _)),
        state_text_forget(Id)
    ;   true
    ).

%!  stay_owner(?Id, +Host, -Owner:atom) is nondet.
%!  stay_count(+Host, +Owner:atom, -Count) is det.
%!  stay_until(+Id, ?Host, -Until:number) is semidet.
%
%   Id stands on Host, which has quotas, and is the owner's; how many of his
%   are there; until when it may be there, on the clock of the host.

stay_owner(Id, Host, Owner) :-
    stays(Id, Host, Owner, _).

typhon_rate_limits:owner(Host, Id, Owner) :-
    stays(Id, Host, Owner, _),
    !.

stay_count(Host, Owner, Count) :-
    aggregate_all(count, stays(_, Host, Owner, _), Count).

stay_until(Id, Host, Until) :-
    stays(Id, Host, _, Until),
    Until \== inf,
    !.
