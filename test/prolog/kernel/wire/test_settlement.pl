:- module(test_settlement, []).

/** <module> The window of a session, and which frames a count settles

*Threading*: one test at a time; no connection and no other thread.
*/

:- use_module('../../../lib/common').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon/kernel/wire/frame), [frame_overhead/1]).
:- use_module(library(typhon/kernel/wire/session)).
:- use_module(library(typhon/kernel/wire/window)).

%   with_window(-Session, -Window, -Out, :Goal): those of a session that has
%   sent and received nothing.

:- meta_predicate with_window(-, -, -, 0).

with_window(Session, Window, Out, Goal) :-
    Hello = hello(p, 1, 'h:1', 90004, 64, none),
    setup_call_cleanup(
        ( session_open(key, Hello-cookie, text, Session),
          session_window(Session, Window),
          open_null_stream(Out) ),
        once(Goal),
        ( close(Out), ignore(closed(Session, _)) )).

closed(Session, Handed) :-
    typhon_session:forget(Session, _, Handed).

received(Session, Count) :-
    session_window(Session, Window),
    forall(between(1, Count, _), window_count(Window, _)).

%   hands_over(+Window, +Out, +Token): a frame of 10 bytes.

hands_over(Window, Out, Token) :-
    window_sent(Window, Out, "0123456789", Token, _).

settled(Session, R, S, Settled) :-
    session_settled(Session, counts(R, S), Settled, _).

long(Bytes, String) :-
    format(string(String), "~`xt~*|", [Bytes]).

:- begin_tests(settlement).

test(frame_that_waits_settles_what_was_settled_when_it_was_put,
     [R, S] == [3, 1]) :-
    with_window(Session, Window, Out,
        ( received(Session, 1),
          window_wait(Window, "x", none),
          received(Session, 2),
          window_next(Window, text, Out, all, counts(R, S), "x") )).
test(frame_that_is_sent_again_settles_what_it_did_before,
     [R, S] == [3, 1]) :-
    with_window(Session, Window, Out,
        ( received(Session, 1),
          hands_over(Window, Out, none),
          received(Session, 2),
          window_resumed(Window, 0, 0, [], [Frame]),
          window_counts(Window, Frame, counts(R, S), _) )).
test(frame_that_is_written_before_those_that_wait_settles_no_more,
     [R, S] == [3, 1]) :-
    with_window(Session, Window, Out,
        ( received(Session, 1),
          hands_over(Window, Out, none),
          received(Session, 2),
          window_wait(Window, "objection", none),
          window_control(Window, Out, all, "", counts(R, S)) )).
test(resumed_count_settles_nothing,
     [Before, After] == [[], [settled(t(1), 1, accepted)]]) :-
    with_window(Session, Window, Out,
        ( hands_over(Window, Out, t(1)),
          window_resumed(Window, 1, 0, Handed, []),
          typhon_session:unsettled_add(key, Handed),
          settled(Session, 1, 0, Before),
          settled(Session, 1, 1, After) )).
test(frames_that_the_peer_has_are_not_sent_again, Again == ["b", "c"]) :-
    with_window(_, Window, Out,
        ( forall(member(Bytes, ["a", "b", "c"]),
                 window_sent(Window, Out, Bytes, none, _)),
          window_resumed(Window, 1, 0, _, Frames),
          findall(B, member(frame(B, _, _), Frames), Again) )).
test(settled_frame_is_accepted_or_has_the_first_objection,
     [All, Rest] == [[settled(t(1), 1, accepted), settled(t(2), 2, full)],
                     [settled(t(3), 3, accepted)]]) :-
    with_window(Session, Window, Out,
        ( forall(member(T, [1, 2, 3]), hands_over(Window, Out, t(T))),
          forall(member(N-Answer, [2-full, 2-spoilt, 0-early, 4-late]),
                 session_objected(Session, N, Answer)),
          settled(Session, 3, 2, All),
          session_objected(Session, 2, again),
          settled(Session, 3, 3, Rest) )).
test(objection_to_a_received_frame_counts_until_it_is_settled,
     Settled == [settled(t(1), 1, full)]) :-
    with_window(Session, Window, Out,
        ( hands_over(Window, Out, t(1)),
          settled(Session, 1, 0, []),
          session_objected(Session, 1, full),
          settled(Session, 1, 1, Settled) )).
test(deferred_answer_replaces_the_objection,
     Settled == [settled(t(1), 1, later)]) :-
    with_window(Session, Window, Out,
        ( hands_over(Window, Out, t(1)),
          session_objected(Session, 1, deferred),
          objection_answered(Session, 1, later),
          settled(Session, 1, 1, Settled) )).
test(session_is_pending_until_the_hand_over_is_settled, Pending == [1, 1, 0]) :-
    with_window(Session, Window, Out,
        ( hands_over(Window, Out, t(1)),
          session_pending(Session, P1),
          settled(Session, 1, 0, _),
          session_pending(Session, P2),
          settled(Session, 1, 1, _),
          session_pending(Session, P3) )),
    Pending = [P1, P2, P3].
test(hand_overs_of_a_closed_session_are_lost_or_unsent,
     Handed == [ handed(t(1), lost), handed(t(2), full), handed(t(3), lost),
                 handed(t(4), unsent) ]) :-
    with_window(Session, Window, Out,
        ( forall(member(T, [1, 2, 3]), hands_over(Window, Out, t(T))),
          window_wait(Window, "x", t(4)),
          settled(Session, 2, 0, []),
          session_objected(Session, 2, full),
          closed(Session, Handed) )).

:- end_tests(settlement).

:- begin_tests(window).

test(frame_does_not_overtake_those_that_wait, fail) :-
    with_window(_, Window, Out,
        ( window_wait(Window, "first", none),
          window_sent(Window, Out, "second", none, _) )).

%   The null stream counts the bytes that are written to it.

test(frames_of_64_kB_are_under_way_at_most, Written == 4) :-
    frame_overhead(Head),
    Length is 65536//4-Head-1,
    long(Length, Bytes),
    with_window(_, Window, Out,
        aggregate_all(count,
                      ( between(1, 10, _),
                        window_sent(Window, Out, Bytes, none, _),
                        long(Head, Space),
                        format(Out, "~s~s", [Space, Bytes]) ),
                      Written)).
test(acknowledged_frame_makes_room, Waits == true) :-
    long(60000, Bytes),
    with_window(Session, Window, Out,
        ( window_sent(Window, Out, Bytes, none, _),
          frame_overhead(Head),
          Written is 60000+Head,
          long(Written, Text),
          write(Out, Text),
          (   window_sent(Window, Out, Bytes, none, _)
          ->  Waits = false
          ;   Waits = true
          ),
          settled(Session, 1, 0, _),
          window_sent(Window, Out, Bytes, none, _) )).
test(count_of_more_than_was_sent,
     error(domain_error(acknowledged, 2))) :-
    with_window(Session, Window, Out,
        ( hands_over(Window, Out, none),
          settled(Session, 2, 0, _) )).

:- end_tests(window).
