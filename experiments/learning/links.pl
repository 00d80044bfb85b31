:- module(learning_links,
          [ degrees/5                   % +Model, +Nodes, +Seed, +End, -Degrees
          ]).
:- use_module('../../prolog/typhon/network/dynamics', [dynamics_model/2]).
:- use_module('../sieve/ground', [ground_links/4, ground_start/4]).
:- use_module(library(lists), [max_list/2, min_list/2]).

/** <module> How many links the hosts of a dynamic mesh have

The changes of links follow from the seed, so they can be gone through
again.

*Threading*: pure.
*/

%!  degrees(+Model, +Nodes:integer, +Seed:integer, +End:number, -Degrees)
%!      is det.
%
%   Degrees is Least-Most: of all hosts, looked at twice in a second from
%   when each has changed its links for the first time until End; before
%   that some have the links of the mesh.  `none` if links do not change
%   (Model is `none`), or if there was no such time.

degrees(none, _, _, _, none) :-
    !.
degrees(Model, Nodes, Seed, End, Degrees) :-
    ground_start(mesh(Nodes), Model, Seed, Ground),
    dynamics_model(Model, General),
    arg(1, General, uniform(_, Changed)),
    seen(Changed, End, Ground, none, Degrees).

seen(Now, End, _, Range, Range) :-
    Now > End,
    !.
seen(Now, End, Ground0, Range0, Range) :-
    ground_links(Now, Ground0, Ground, Links),
    findall(Degree, ( arg(_, Links, Ns), length(Ns, Degree) ), Degrees),
    widened(Range0, Degrees, Range1),
    Next is Now + 0.5,
    seen(Next, End, Ground, Range1, Range).

widened(none, Degrees, Least-Most) :-
    !,
    min_list(Degrees, Least),
    max_list(Degrees, Most).
widened(Least0-Most0, Degrees, Least-Most) :-
    min_list([Least0|Degrees], Least),
    max_list([Most0|Degrees], Most).
