:- module(typhon_ros_wishes,
          [ wish/4,                     % +Host, +Who, +Op, -New
            wish_end/4,                 % +Host, ?Who, +Op, -Last
            wishes_of/3,                % +Host, +Who, -Ops
            wished_by/3,                % +Host, ?Op, -Who
            wished/2,                   % +Host, -Op
            wishes_forget/1             % +Host
          ]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> What is to hold as long as somebody wishes it

Topics that agents hear, or on which something is published, and services
that they offer: an Op of op_undone/2, wished by agents, or by `host`.  ROS is
told when somebody is the first to wish it, and when nobody does any more;
and a server that comes back is told it all again.

*Threading*: any thread; a mutex lets nobody come between a look at a wish
and its change.
*/

:- setting(most_wishes, nonneg, 10000,
           "Topics and services of one host, counted for each agent").

:- dynamic
    wish/3.                     % Host, Op, Who

%!  wish(+Host, +Who, +Op, -New:boolean) is det.
%
%   New says whether nobody has wished Op before.
%
%   @error resource_error(ros_wishes)

wish(Host, Who, Op, New) :-
    with_mutex(typhon_ros_wishes, add(Host, Who, Op, New)).

add(Host, Who, Op, false) :-
    wish(Host, Op, Who),
    !.
add(Host, Who, Op, New) :-
    room(Host),
    ( wish(Host, Op, _) -> New = false ; New = true ),
    assertz(wish(Host, Op, Who)).

room(Host) :-
    setting(most_wishes, Most),
    predicate_property(wish(_, _, _), number_of_clauses(Count)),
    (   Count < Most
    ->  true
    ;   aggregate_all(count, wish(Host, _, _), Own),
        Own < Most
    ->  true
    ;   resource_error(ros_wishes)
    ).

%!  wish_end(+Host, ?Who, +Op, -Last:boolean) is semidet.
%
%   Last says whether nobody wishes Op any more.  Fails if Who did not.

wish_end(Host, Who, Op, Last) :-
    with_mutex(typhon_ros_wishes, end(Host, Who, Op, Last)).

end(Host, Who, Op, Last) :-
    retract(wish(Host, Op, Who)),
    !,
    ( wish(Host, Op, _) -> Last = false ; Last = true ).

%!  wishes_of(+Host, +Who, -Ops:list) is det.
%!  wished_by(+Host, ?Op, -Who) is nondet.
%!  wished(+Host, -Op) is nondet.

wishes_of(Host, Who, Ops) :-
    findall(Op, wish(Host, Op, Who), Ops).

wished_by(Host, Op, Who) :-
    wish(Host, Op, Who).

wished(Host, Op) :-
    findall(Op0, wish(Host, Op0, _), Ops),
    distinct_in_order(Ops, Op).

distinct_in_order(Ops, Op) :-
    list_to_set(Ops, Set),
    member(Op, Set).

%!  wishes_forget(+Host) is det.

wishes_forget(Host) :-
    retractall(wish(Host, _, _)).
