:- module(typhon_ros_service, []).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [service/2, service_begin/4, service_end/2]).
:- use_module(answers, [answers_fail/2]).
:- use_module(events, [ros_ignored/2]).
:- use_module(standing, [standing/3, standing_forget/1]).
:- use_module(ways, [way_close/1, way_open/3, way_state/3]).
:- use_module(words, [ros_words/1]).

/** <module> A host with ROS

Where it begins is ros_start/3; what ros_property/2 tells comes from here.

*Threading*: any thread.
*/

:- multifile
    typhon_options:declared/4,
    typhon_services:ends/2,
    typhon_starting:has/3,
    typhon_starting:starts/4.

typhon_starting:starts(ros, Host, Where, Options) :-
    check_options(ros_option, Options),
    check_where(Where),
    ros_words(PIs),
    service_begin(ros, Host, PIs, typhon_ros_words),
    catch(way_open(Host, Where, Options), Ball,
          ( service_end(ros, Host),
            throw(Ball) )).

check_where(ros2) :-
    !.
check_where(URL) :-
    (   member(Scheme, ['ws://', 'wss://']),
        atom_concat(Scheme, _, URL)
    ->  true
    ;   domain_error(ros, URL)
    ).

typhon_options:declared(ros_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(messages(X), oneof([dict,terms]), X).
option_type(deadline(X), between(0.01, 3600), X).
option_type(connect_deadline(X), between(0.01, 3600), X).
option_type(silence(X), between(0.1, 3600), X).
option_type(node(X), atom, X).
option_type(domain(X), between(0, 232), X).
option_type(reach(X), oneof([localhost,subnet]), X).
option_type(python(X), atom, X).

typhon_services:ends(ros, Host) :-
    way_close(Host),
    answers_fail(Host, stopped),
    standing_forget(Host).

typhon_starting:has(ros, Host, Property) :-
    service(ros, Host),
    property(Property, Host).

property(way(Where), Host) :-
    way_state(Host, Where, _).
property(connected(Connected), Host) :-
    way_state(Host, _, Connected).
property(heard(Topic, Type), Host) :-
    standing(Host, _, subscribe(Topic, Type)).
property(published(Topic, Type), Host) :-
    standing(Host, _, advertise(Topic, Type)).
property(offered(Service, Type), Host) :-
    standing(Host, _, offer(Service, Type)).
property(ignored(Count), Host) :-
    ros_ignored(Host, Count).
