:- module(typhon_senders,
          [ shown/5,                    % +Endpoint, +Ids, +There, +Term,
                                        % -Shown
            mail_parts/4                % +Endpoint, +Id, +Mail, -Parts
          ]).

/** <module> What is shown with what agents say

For the authorization of senders see typhon_speakers. The birth of an agent is
shown to its home, and to where it went, and to no other process: others could speak
for it from then on. So what an agent says away from home goes through its
home, unless it goes to one whose way leads from here.

*Threading*: any thread; no state.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module('../wire', [endpoint_address/1, endpoint_keys/1]).
:- use_module('../agent',
              [agent_home_endpoint/2, agent_owned/1, birth_shown/2]).

%!  shown(+Endpoint, +Ids, +There, +Term, -Shown) is det.
%
%   What is sent to Endpoint instead of Term: shown(Births, Term), with what we
%   have of those of the agents Ids, if that is their home, and of the agents
%   There; or Term.

shown(Endpoint, Ids, There, Term, Shown) :-
    endpoint_keys(_),
    findall(Birth, to_show(Endpoint, Ids, There, Birth), Births0),
    Births0 \== [],
    sort(Births0, Births),
    !,
    Shown = shown(Births, Term).
shown(_, _, _, Term, Term).

to_show(Endpoint, Ids, There, Birth) :-
    (   member(Id, Ids),
        of_others(Id),
        agent_home_endpoint(Id, Endpoint)
    ;   member(Id, There),
        of_others(Id)
    ),
    birth_shown(Id, Birth).

of_others(Id) :-
    atom(Id),
    \+ agent_owned(Id).

%!  mail_parts(+Endpoint, +Id, +Mail, -Parts) is det.
%
%   Parts are Via-Some, Some of Mail, which is for Id at Endpoint, and Via the
%   endpoint to which it goes at first.

mail_parts(Endpoint, Id, Mail, Parts) :-
    (   endpoint_keys(_),
        of_others(Id),
        \+ birth_shown(Id, _)
    ->  maplist(via(Endpoint), Mail, Pairs),
        keysort(Pairs, Sorted),
        group_pairs_by_key(Sorted, Parts)
    ;   Parts = [Endpoint-Mail]
    ).

via(Endpoint, Mail, Via-Mail) :-
    Mail = mail(Origin, From, _),
    (   of_others(From),
        endpoint_address(Origin),
        agent_home_endpoint(From, Home),
        \+ endpoint_address(Home)
    ->  Via = Home
    ;   Via = Endpoint
    ).
