:- module(typhon_away, []).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(option), [option/2]).
:- use_module('../../kernel/host', [host_option/2, time_apart/2, time_kind/1]).

/** <module> Hosts that are away for a while, in virtual time

With the option away(true), of host_change/2, a host is out of reach: moves and
messages between it and other hosts fail, as those to a process that is gone.
Its agents go on.  Only where all hosts are in one process, as in virtual time,
is that the whole truth; so the option is for these.

*Threading*: any thread.
*/

:- multifile
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:check/1,
    typhon_host_parts:part/4,
    typhon_options:declared/4.

:- public same/4.

typhon_options:declared(host_option, away(X), boolean, X).

typhon_host_parts:changeable(away(_)).

typhon_host_parts:changes(away(true), _) :-
    must_be_alone.

typhon_host_parts:check(Options) :-
    (   option(away(true), Options)
    ->  permission_error(start, away, host)
    ;   true
    ).

must_be_alone :-
    (   time_kind(Kind),
        time_apart(Kind, _)
    ->  true
    ;   permission_error(change, host_option, away(true))
    ).

typhon_host_parts:part(away, Host, 0, true) :-
    host_option(Host, away(true)).

%   With a part in this phase the host checks where each message comes from.

typhon_host_parts:part(deliver, Host, 0, typhon_away:same) :-
    host_option(Host, away(true)).

same(_, _, Mail, Mail).
