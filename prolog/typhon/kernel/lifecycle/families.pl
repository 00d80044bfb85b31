:- module(typhon_families,
          [ may_clone/2                 % +Id, +Here
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module('../host',
              [ quota/3, quota_any/1, quota_passed/1, quota_shared/4,
                quota_spend/4 ]).
:- use_module('../agent', [agent/5, stay_count/3, stay_owner/3]).

/** <module> How many clones there may be

*Threading*: in the worker that has the agent.
*/

%!  may_clone(+Id, +Here) is det.
%
%   Of its program and owner, of all programs of the owner, and of all there are
%   not too many here.  Nor have been made in this second: else a family would
%   clone for ever, as fast as those end that are too many.
%
%   @error resource_error(clones)

may_clone(Id, Here) :-
    quota_any(Here),
    stay_owner(Id, Here, Owner),
    !,
    family_may_clone(Id, Here, Owner),
    (   quota_shared(Here, Whose, clones, Most),
        ( Whose == host -> true ; Of = Owner ),
        stay_count(Here, Of, Count),
        Count > Most
    ->  quota_passed(clones)
    ;   true
    ).
may_clone(_, _).

family_may_clone(Id, Here, Owner) :-
    quota(Here, clones, Most),
    !,
    agent(Id, _, _, Hash, _),
    aggregate_all(count,
                  ( stay_owner(Other, Here, Owner),
                    agent(Other, Here, _, Hash, _) ),
                  Count),
    (   Count > Most
    ->  quota_passed(clones)
    ;   atomic_list_concat([Owner,Hash], ' ', Family),
        quota_spend(Here, Family, clones, Most)
    ).
family_may_clone(_, _, _).
