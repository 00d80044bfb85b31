:- module(typhon_ros_advertisements,
          [ claim/3,                    % +Host, +Key, +Op
            registration/3,             % ?Host, ?Key, ?Op
            registration_end/3,         % +Host, +Key, -Op
            registration_renew/3,       % +Host, +Key, -Op
            registrations_forget/1      % +Host
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [permission_error/3, resource_error/1]).
:- use_module(library(lists), [append/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/bounds', [bounded/3]).
:- use_module(connection, [way_send/2]).

/** <module> Advertisements and subscriptions of a host in ROS

An entry of the table is an operation Op that is in force under a Key: the host
has advertised a topic, advertise(Topic), subscribed to a topic, topic(Topic),
or advertised a service, service(Service).  The host repeats these operations to
a server that was down.

*Threading*: any thread.
*/

%!  claim(+Host, +Key, +Op) is det.
%
%   Put Op in force under Key, unless it is already.  A server that is down gets
%   it when it is up again.
%
%   @error permission_error(use, ros_topic(Type), Topic) if Topic is in use with
%          messages of another Type, and the errors of way_send/2

claim(Host, _, Op) :-
    conflict(Op, Host, Topic, Other),
    !,
    permission_error(use, ros_topic(Other), Topic).
claim(Host, Key, Op) :-
    registration(Host, Key, Op),
    !.
claim(Host, Key, Op) :-
    registration_begin(Host, Key, Op),
    catch(way_send(Host, Op), error(Formal, Context), true),
    (   ( var(Formal) ; Formal = ros_error(not_connected, _) )
    ->  true
    ;   ignore(registration_end(Host, Key, _)),
        throw(error(Formal, Context))
    ).

conflict(Op, Host, Topic, Other) :-
    of_topic(Op, Topic, Type),
    ( Key = advertise(Topic) ; Key = topic(Topic) ),
    registration(Host, Key, Op0),
    of_topic(Op0, Topic, Other),
    \+ same_type(Type, Other).

of_topic(advertise(Topic, Type), Topic, Type).
of_topic(subscribe(Topic, Type), Topic, Type).

%   ROS 1 omits the middle part of a type, and servers of ROS 2 accept both.

same_type(Type, Type) :-
    !.
same_type(Type1, Type2) :-
    ends(Type1, Ends),
    ends(Type2, Ends).

ends(Type, Package/Name) :-
    atomic_list_concat(Parts, /, Type),
    append([Package|_], [Name], Parts),
    !.

                /*******************************
                *            TABLE             *
                *******************************/

:- setting(most, positive_integer, 1000,
           "Topics and services that a host may use, each in its way").

:- dynamic
    registration/3,             % Host, Key, Op
    ended/3.                    % Host, Key, Op: ended; bounded

%!  registration(?Host, ?Key, ?Op) is nondet.
%!  registration_begin(+Host, +Key, +Op) is det.
%!  registration_end(+Host, +Key, -Op) is semidet.
%!  registration_renew(+Host, +Key, -Op) is semidet.
%!  registrations_forget(+Host) is det.
%
%   Op is in force under Key; put it in force; end it; put the Op that ended
%   last under Key in force again; delete all entries of Host.
%
%   @error resource_error(ros_standing) Host has too many entries

registration_begin(Host, Key, Op) :-
    with_mutex(typhon_ros_advertisements, begin(Host, Key, Op)).

begin(Host, Key, _) :-
    registration(Host, Key, _),
    !.
begin(Host, Key, Op) :-
    aggregate_all(count, registration(Host, _, _), Count),
    setting(most, Most),
    (   Count < Most
    ->  assertz(registration(Host, Key, Op))
    ;   resource_error(ros_standing)
    ).

registration_end(Host, Key, Op) :-
    with_mutex(typhon_ros_advertisements, end(Host, Key, Op)).

end(Host, Key, Op) :-
    retract(registration(Host, Key, Op)),
    !,
    retractall(ended(Host, Key, _)),
    bounded(ended(_, _, _), typhon_ros_advertisements:most,
            assertz(ended(Host, Key, Op))).

registration_renew(Host, Key, Op) :-
    ended(Host, Key, Op),
    !,
    registration_begin(Host, Key, Op).

registrations_forget(Host) :-
    retractall(registration(Host, _, _)),
    retractall(ended(Host, _, _)).
