:- module(learning_degrees,
          [ degrees/5                   % +Model, +Count, +Seed, +End, -Degrees
          ]).
:- use_module('../../prolog/typhon/network/dynamics',
              [dynamics_event/4, dynamics_model/2, dynamics_state/5]).
:- use_module(library(apply), [foldl/4, maplist/2]).
:- use_module(library(lists), [max_list/2, member/2, min_list/2]).

/** <module> The number of links of hosts in a dynamic mesh

The seed determines the changes of links, so the changes are recomputed here.

*Threading*: pure.
*/

%!  degrees(+Model, +Count:integer, +Seed:integer, +End:number, -Degrees)
%!      is det.
%
%   Degrees is Least-Most, the range of degrees of Count hosts from the time at
%   which every host has changed its links once until End; before it some hosts
%   have the links of the mesh.  `none` if there is no such time.

degrees(Model0, Count, Seed, End, Degrees) :-
    dynamics_model(Model0, Model),
    findall(I-J, ( between(1, Count, I), between(I, Count, J), I < J ), Edges),
    dynamics_state(Model, Count, Edges, Seed, State),
    functor(Now, degrees, Count),
    Now =.. [_|All],
    Links is Count - 1,
    maplist(=(Links), All),
    arg(1, Model, uniform(_, Changed)),
    gone_through(State, Changed-End, Now, none, Degrees).

gone_through(State0, Begin-End, Now, Seen0, Seen) :-
    dynamics_event(State0, Time, Changes, State),
    Time =< End,
    !,
    foldl(changed, Changes, Now, Then),
    (   Time < Begin
    ->  Seen1 = Seen0
    ;   widened(Seen0, Then, Seen1)
    ),
    gone_through(State, Begin-End, Then, Seen1, Seen).
gone_through(_, _, _, Seen, Seen).

changed(Change, Now, Then) :-
    more(Change, I, J, By),
    duplicate_term(Now, Then),
    forall(member(H, [I, J]),
           ( arg(H, Then, N0), N is N0 + By, nb_setarg(H, Then, N) )).

more(link(I, J), I, J, 1).
more(unlink(I, J), I, J, -1).

widened(Seen, Now, Least-Most) :-
    Now =.. [_|All],
    (   Seen = Least0-Most0
    ->  min_list([Least0|All], Least),
        max_list([Most0|All], Most)
    ;   min_list(All, Least),
        max_list(All, Most)
    ).
