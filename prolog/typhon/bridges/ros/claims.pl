:- module(typhon_ros_claims,
          [ claim/3                     % +Host, +Key, +Op
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module(standing, [standing/3, standing_begin/3, standing_end/3]).
:- use_module(ways, [way_say/2]).

/** <module> To say what is to hold

*Threading*: the thread that runs the agent.
*/

%!  claim(+Host, +Key, +Op) is det.
%
%   Op holds under Key, from now on if it did not before.  A server that is
%   not there will be told when it is.
%
%   @error permission_error(use, ros_topic(Type), Topic) if it is in use with
%          messages of another Type, and those of way_say/2

claim(Host, _, Op) :-
    conflict(Op, Host, Topic, Other),
    !,
    permission_error(use, ros_topic(Other), Topic).
claim(Host, Key, Op) :-
    standing(Host, Key, Op),
    !.
claim(Host, Key, Op) :-
    standing_begin(Host, Key, Op),
    catch(way_say(Host, Op), error(Formal, Context), true),
    (   ( var(Formal) ; Formal = ros_error(not_connected, _) )
    ->  true
    ;   ignore(standing_end(Host, Key, _)),
        throw(error(Formal, Context))
    ).

conflict(Op, Host, Topic, Other) :-
    of_topic(Op, Topic, Type),
    ( Key = advertise(Topic) ; Key = topic(Topic) ),
    standing(Host, Key, Op0),
    of_topic(Op0, Topic, Other),
    \+ same_type(Type, Other).

of_topic(advertise(Topic, Type), Topic, Type).
of_topic(subscribe(Topic, Type), Topic, Type).

%   ROS 1 leaves out the part in the middle, and servers of ROS 2 take both.

same_type(Type, Type) :-
    !.
same_type(Type1, Type2) :-
    ends(Type1, Ends),
    ends(Type2, Ends).

ends(Type, Package/Name) :-
    atomic_list_concat(Parts, /, Type),
    append([Package|_], [Name], Parts),
    !.
