:- module(typhon_admission,
          [ quota_against/3             % +Host, +Newcomer, -Reason
          ]).
:- use_module('../host', [quota/3, quota_shared/4]).
:- use_module(owner, [owner_key/2, owner_of/5]).
:- use_module(stay, [stay_count/3]).

/** <module> For whom a host has no room

*Threading*: any thread; no state.  Of many that come at once each may be one
too many.
*/

%!  quota_against(+Host, +Newcomer, -Reason) is semidet.
%
%   Newcomer, newcomer(Id, Hash, State, Mail), cannot come to Host: State is as
%   of owner_of/5, Mail how many messages wait for it.  Reason is quota(What).

quota_against(Host, newcomer(_, _, _, Mail), quota(mailbox)) :-
    quota(Host, mailbox, Most),
    Mail > Most,
    !.
quota_against(Host, newcomer(_, _, module(Module), _), quota(state)) :-
    quota(Host, state, Most),
    module_property(Module, program_size(Size)),
    Size > Most,
    !.
quota_against(Host, newcomer(Id, Hash, State, _), quota(agents)) :-
    quota_shared(Host, owner, agents, Most),
    owner_of(Host, Id, Hash, State, Owner),
    owner_key(Owner, Key),
    stay_count(Host, Key, Count),
    Count >= Most,
    !.
