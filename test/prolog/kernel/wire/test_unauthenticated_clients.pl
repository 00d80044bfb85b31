:- module(test_unauthenticated_clients, []).

% Clients that do not authenticate: the resources that they can hold, and the
% reports about them.

:- use_module('../../../lib/common').
:- use_module('../../../lib/endpoints').
:- use_module('../../../lib/plain_client').
:- use_module('../../../lib/slowness', [patience/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(socket)).
:- use_module(library(thread), [concurrent_maplist/3]).
:- use_module(library(typhon/kernel/wire)).

:- dynamic
    told/1,
    broken/2.                           % Level, Formal
:- multifile user:message_hook/3.

user:message_hook(typhon(endpoint, broken(_, Formal)), Level, _) :-
    assertz(broken(Level, Formal)).
user:message_hook(typhon(endpoint, Message), _, _) :-
    assertz(told(Message)).

:- meta_predicate
    fresh(0),
    patiently(0),
    with_silent(+, -, 0).

%   fresh(:Goal): as with_endpoint/1; the log is empty.

fresh(Goal) :-
    retractall(told(_)),
    with_endpoint(Goal).

%   No client is refused for being slow; `soon` is much shorter.

patiently(Goal) :-
    patience(120, Seconds),
    with_settings([typhon_handshake:handshake_time=Seconds], Goal).

soon(Seconds) :-
    assertion(soon(Seconds, 20)).

connected(streams(In, Out)) :-
    endpoint_port(Port),
    tcp_socket(Socket),
    tcp_connect(Socket, '127.0.0.1':Port),
    tcp_open_socket(Socket, In, Out),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)).

closed(streams(In, Out)) :-
    close(Out, [force(true)]),
    close(In, [force(true)]).

say(Text, streams(_, Out)) :-
    catch(( write(Out, Text), flush_output(Out) ), error(_, _), true).

with_silent(Count, Clients, Goal) :-
    length(Clients, Count),
    setup_call_cleanup(maplist(connected, Clients),
                       Goal,
                       maplist(closed, Clients)).

shouts(Text) :-
    with_client(In, Out, say(Text, streams(In, Out))).

%   The log reports so many refusals for this reason.

turned_away(Why, Count) :-
    findall(Some,
            (   told(turned_away(_, Why)),
                Some = 1
            ;   told(turned_away(Groups)),
                member(Some-(_-Why), Groups)
            ),
            Counts),
    sum_list(Counts, Count).

%   Authenticate to the endpoint; Seconds is the time it takes.

newcomer(I, Seconds) :-
    atom_concat(newcomer, I, Process),
    elapsed(with_client(In, Out, client_authenticate(In, Out, Process)),
            Seconds).

slots(Count) :-
    aggregate_all(count, typhon_connection:unproved(_, _, _, _), Count).

:- begin_tests(silent_clients_do_not_block_peers).

test(newcomers_are_accepted, [forall(member(Slots-Silent, [32-32, 32-200,
                                                           128-200]))]) :-
    fresh(patiently(
        with_settings([typhon_acceptor:unproved=Slots], crowded(Silent)))).
test(newcomers_are_accepted_without_delay) :-
    fresh(patiently(with_settings([typhon_acceptor:unproved=16],
        with_silent(16, _,
            ( wait_until(silent(16), 30),
              numlist(1, 6, Newcomers),
              concurrent_maplist(newcomer, Newcomers, Times),
              maplist(soon, Times) ))))).
test(active_client_stays) :-
    fresh(patiently(with_settings([typhon_acceptor:unproved=4],
        with_silent(4, [Talker|_],
            ( say("ty", Talker),
              wait_until(stages([heard, silent, silent, silent]), 30),
              with_silent(3, _,
                  ( wait_until(turned_away(silent, 3), 30),
                    wait_until(stages([heard, silent, silent, silent]), 30)
                  )) ))))).

%   silent(+Count): Count clients had time to authenticate, and did not; the
%   acceptor evicts the oldest of them first.

silent(Count) :-
    stages(Stages),
    length(Stages, Count),
    forall(member(Stage, Stages), Stage == silent).

stages(Stages) :-
    findall(Stage, typhon_connection:unproved(_, _, _, Stage), Stages0),
    msort(Stages0, Stages).

crowded(Silent) :-
    with_silent(Silent, _,
        ( numlist(1, 6, Newcomers),
          maplist(newcomer, Newcomers, Times),
          maplist(soon, Times) )),
    wait_until(slots(0), 30).

:- end_tests(silent_clients_do_not_block_peers).

:- begin_tests(order_of_eviction, [cleanup(forget_all)]).

%   evicted(-Slots, -Proved, -Client): Client of these
%   Client-Address-Since-Stage is evicted, if peers at the addresses Proved have
%   authenticated.

evicted([a-x-1-silent,b-x-2-heard,c-y-3-silent,d-y-4-silent,e-y-5-heard], [],
        c).                             % from most connections
evicted([a-x-1-heard,b-x-2-silent,c-x-3-silent], [], b).    % silent
evicted([a-x-2-heard,b-x-1-heard], [], b).                  % the oldest
evicted([a-x-1-silent,b-x-2-silent,c-x-3-silent,d-y-4-heard], [x], d).

test(evicted, [ forall(evicted(Slots, Proved, Expected)), V == Expected ]) :-
    slots(Slots, Proved, V).
test(addresses_are_bounded, Count == 256) :-
    forget_all,
    forall(between(1, 1000, I), typhon_connection:remember(I)),
    typhon_connection:proved(1000),
    aggregate_all(count, typhon_connection:proved(_), Count).

slots(Slots, Proved, Victim) :-
    forget_all,
    forall(member(Thread-Ip-Since-Stage, Slots),
           assertz(typhon_connection:unproved(Thread, Ip, Since, Stage))),
    forall(member(Ip, Proved), assertz(typhon_connection:proved(Ip))),
    typhon_connection:victim(Victim, _).

forget_all :-
    retractall(typhon_connection:unproved(_, _, _, _)),
    retractall(typhon_connection:proved(_)).

:- end_tests(order_of_eviction).

:- begin_tests(slots_are_freed).

test(thread_creation_fails) :-
    fresh(( setup_call_cleanup(
                wrap_predicate(typhon_threads:create(_, _, _, _), none, _,
                               throw(error(resource_error(threads), _))),
                ( forall(between(1, 3, _), shouts("typhon")),
                  wait_until(turned_away(resource_error(threads), 3), 30) ),
                unwrap_predicate(typhon_threads:create/4, none)),
            assertion(slots(0)),
            newcomer(x, _) )).
test(clients_die_at_any_moment) :-
    fresh(( forall(between(1, 300, I), dies(I)),
            wait_until(slots(0), 30),
            newcomer(x, _) )).
test(threads_are_stopped_at_any_moment) :-
    forall(between(1, 20, _), fresh(forall(between(1, 15, I), dies(I)))).
test(clients_are_evicted_at_any_moment) :-
    fresh(with_settings([typhon_acceptor:unproved=2],
                        ( forall(between(1, 300, I), dies(I)),
                          wait_until(slots(0), 30) ))).

%   Sends a greeting of so many bytes, and disconnects.

dies(I) :-
    greeting(x, Line),
    string_concat(Line, "\n", Greeting),
    string_length(Greeting, Length),
    Bytes is I mod (Length+1),
    sub_string(Greeting, 0, Bytes, _, Text),
    shouts(Text).

:- end_tests(slots_are_freed).

%   breaks_off(+Text, -Level, -Formal): the message about the connection of a
%   client that authenticates, sends Text and closes the connection.

breaks_off(Text, Level, Formal) :-
    retractall(broken(_, _)),
    fresh(( with_client(In, Out, ( client_authenticate(In, Out, breaker),
                                   say(Text, streams(In, Out)) )),
            wait_until(broken(Level, Formal), 30) )).

:- begin_tests(refused_clients_are_reported).

test(few_lines_count_all_refusals, Sum == 500) :-
    get_time(T0),
    fresh(( forall(between(1, 500, _), shouts("GET / HTTP/1.0\r\n")),
            wait_until(counted(500), 30) )),
    get_time(T1),
    counted(Sum),
    aggregate_all(count, told(_), Lines),
    assertion(Lines =< 3+(T1-T0)).
test(refusal_with_a_reused_slot_is_reported_once, Sum == 50) :-
    setup_call_cleanup(
        wrap_predicate(typhon_connection:refused(_, _), slow, Counted,
                       ( Counted, sleep(0.01) )),
        with_settings([typhon_acceptor:unproved=2],
                      fresh(( forall(between(1, 50, _), shouts("typhon\n")),
                              wait_until(( noted_so_far(N), N >= 50 ), 30) ))),
        unwrap_predicate(typhon_connection:refused/2, slow)),
    noted_so_far(Sum).
test(refusals_are_reported_at_the_end, Sum == 20) :-
    fresh(( forall(between(1, 20, _), shouts("\n")),
            wait_until(noted(20), 30) )),
    counted(Sum).
test(last_refusals_are_reported, Sum == 20) :-
    setup_call_cleanup(
        wrap_predicate(typhon_threads:wire_threads_end, last, End,
                       ( End,
                         forall(between(1, 20, _),
                                typhon_connection:refused(x, silent)) )),
        fresh(true),
        unwrap_predicate(typhon_threads:wire_threads_end/0, last)),
    counted(Sum).
test(broken_connection,
     [ forall(member(Text-Expected,
                     [ "resume 0\nno frame, but words"-warning,
                       "resume 0\nabc"-silent ])),     % within a frame
       Level == Expected ]) :-
    breaks_off(Text, Level, _).
test(client_of_another_version, Line == "typhon 3") :-
    fresh(with_client(In, Out,
        ( say("typhon 1 00 p 1 a:1 90004 64 little\n", streams(In, Out)),
          read_line_to_string(In, Line),
          wait_until(told(turned_away(_, version(1))), 30) ))).
test(server_of_another_version,
     [error(permission_error(authenticate, peer, version(3)))]) :-
    typhon_handshake:check_protocol("typhon 3").

counted(Sum) :-
    turned_away(_, Sum).

noted(Sum) :-
    noted_so_far(Noted),
    Sum =:= Noted.

noted_so_far(Sum) :-
    counted(Told),
    findall(Count, typhon_reports:tally(refused_clients, _, _, Count), Counts),
    sum_list(Counts, More),
    Sum is Told+More.

:- end_tests(refused_clients_are_reported).
