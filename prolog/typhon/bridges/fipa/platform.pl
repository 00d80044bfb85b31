:- module(typhon_fipa_platform,
          [ platform/4,                 % ?Host, ?Name, ?Url, ?Limits
            platform_add/4,             % +Host, +Name, +Url, +Limits
            platform_remove/1,          % +Host
            platform_aid/3,             % +Host, +Local, -Aid
            platform_local/3,           % +Host, +Name, -Local
            platform_count/2,           % +Host, +What
            platform_counts/2,          % +Host, -Counts
            platform_met/2,             % +Name, +Addresses
            platform_way/2              % +Aid, -Addresses
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../../kernel/base/bounds', [bounded/3]).
:- use_module(sexp, [aid_addresses/2, aid_name/2]).

/** <module> Platforms of FIPA: names, addresses and counts

A host with a message transport is a platform of FIPA: it has a name and a URL.
Its agents are named Id@Platform, the managers ams@Platform and df@Platform.

*Threading*: any thread.
*/

:- setting(met, positive_integer, 10000,
           "Agents of other platforms whose addresses are remembered").

:- dynamic
    platform/4,                 % Host, Name, Url, Limits
    met/2.                      % Name, Addresses

%!  platform(?Host, ?Name, ?Url, ?Limits) is nondet.
%!  platform_add(+Host, +Name, +Url, +Limits) is det.
%!  platform_remove(+Host) is semidet.
%
%   Host is a platform; make it one, with counts of 0; remove it.  Limits is a
%   list of options.

platform_add(Host, Name, Url, Limits) :-
    forall(counted(What), ( key(Host, What, Key), flag(Key, _, 0) )),
    assertz(platform(Host, Name, Url, Limits)).

platform_remove(Host) :-
    retract(platform(Host, _, _, _)),
    !.

%!  platform_aid(+Host, +Local, -Aid) is det.
%!  platform_local(+Host, +Name, -Local) is semidet.
%
%   Aid is the identifier of Local, an agent's id, `ams` or `df`, on the
%   platform of Host; Name is the name of Local on that platform.

platform_aid(Host, Local, fipa(Name, [Url])) :-
    platform(Host, Platform, Url, _),
    !,
    atomic_list_concat([Local, Platform], @, Name).

platform_local(Host, Name, Local) :-
    platform(Host, Platform, _, _),
    atom_concat(@, Platform, End),
    atom_concat(Local, End, Name),
    !.

                /*******************************
                *            COUNTS            *
                *******************************/

counted(sent).
counted(received).
counted(failed).
counted(dropped).
counted(refused).

key(Host, What, Key) :-
    atomic_list_concat([typhon_fipa, What, Host], ' ', Key).

%!  platform_count(+Host, +What) is det.
%!  platform_counts(+Host, -Counts:list) is det.
%
%   Count one more What; return all counts, What(N).  What is `sent` or
%   `received`, for messages; `failed`, for messages that were not delivered;
%   `dropped`, for messages beyond a limit; `refused`, for requests without a
%   valid message.

platform_count(Host, What) :-
    key(Host, What, Key),
    flag(Key, N, N+1).

platform_counts(Host, Counts) :-
    findall(Count,
            ( counted(What),
              key(Host, What, Key),
              flag(Key, N, N),
              Count =.. [What,N] ),
            Counts).

%!  platform_met(+Name, +Addresses:list) is det.
%!  platform_way(+Aid, -Addresses:list) is det.
%
%   Remember the Addresses of an agent of another platform; return the addresses
%   of Aid, those given in it, or else the remembered ones.
%
%   @error existence_error(fipa_address, Name)

platform_met(_, []) :-
    !.
platform_met(Name, Addresses) :-
    (   met(Name, Addresses)
    ->  true
    ;   with_mutex(typhon_fipa_met, meet(Name, Addresses))
    ).

meet(Name, Addresses) :-
    findall(Ref, clause(met(Name, _), true, Ref), Refs),
    bounded(met(_, _), typhon_fipa_platform:met,
            assertz(met(Name, Addresses))),
    forall(member(Ref, Refs), catch(erase(Ref), error(_, _), true)).

platform_way(Aid, Addresses) :-
    aid_name(Aid, Name),
    (   aid_addresses(Aid, Given),
        Given \== []
    ->  Addresses = Given
    ;   met(Name, Known)
    ->  Addresses = Known
    ;   existence_error(fipa_address, Name)
    ).
