:- module(test_protocol, []).

/** <module> The protocol of doc/wire.md, as another program sees it

The client here shares no code with the product.

*Threading*: one test at a time; the hooks run in threads of the endpoint.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/endpoints').
:- use_module('../../../lib/plain_client').
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(sha), [sha_hash/3]).
:- use_module(library(typhon/kernel/wire)).

%   The messages about the faults of the client are not printed.  No count is
%   sent because of silence.

:- multifile user:message_hook/3.
:- dynamic note/1, user:message_hook/3.

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_endpoint:handed/4,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(post, note, _, none, none).
typhon_kinds:accepts(request, echo, _, none, none).
typhon_kinds:accepts(request, no_hook, _, none, none).
typhon_kinds:accepts(request, take, _, none, none).
typhon_kinds:accepts(hand, take, _, none, none).

typhon_endpoint:received(note, Note, _) :-
    assertz(note(Note)).
typhon_endpoint:requested(echo, Term, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Term).
typhon_endpoint:requested(take, Term, _, ReplyTo) :-
    endpoint_reply(ReplyTo, taken(Term)).
typhon_endpoint:handed(take, Verdict, _, Verdict).

                /*******************************
                *            CLIENT            *
                *******************************/

:- meta_predicate served(0), talking(+, +, -, -, 0).

served(Goal) :-
    retractall(note(_)),
    setup_call_cleanup(
        asserta((user:message_hook(typhon(endpoint, _), _, _) :- true), Hook),
        with_settings([typhon_reader:silence=100],
                      with_endpoint(Goal)),
        erase(Hook)).

%   talking(+Process, +Has, -In-Out, -Count, :Goal): a process that has received
%   Has frames connects; the endpoint has received Count.  A key that begins
%   with z is not the smaller one.

talking(Process, Has, In-Out, Count, Goal) :-
    with_client(In, Out,
        ( client_authenticate(In, Out, Process),
          read_line_to_string(In, Line),
          string_concat("resume ", Digits, Line),
          number_string(Count, Digits),
          format(Out, "resume ~d\n", [Has]),
          flush_output(Out),
          once(Goal) )).

%   send(+Streams, +Term): as text, with its mark.

send(_-Out, Term) :-
    mark(Term, Kind, Id),
    format(string(Body), "~q. ", [Term]),
    frame(Kind, Id, Body, Bytes),
    put_frame(Out, 0, 0, Bytes).

mark(request(Id, _, _), ?, Id) :- !.
mark(answer(Id, _), =, Id) :- !.
mark(_, -, 0).

frame(Kind, Id, Body, Bytes) :-
    format(string(Bytes), "#~w~`0t~d~20|~s", [Kind, Id, Body]).

put_frame(Out, R, S, Bytes) :-
    check(Bytes, R, S, Check),
    put_frame(Out, R, S, Check, Bytes).

put_frame(Out, R, S, Check, Bytes) :-
    string_length(Bytes, Length),
    forall(member(N-Size, [Length-4, Check-3, R-4, S-4]), put(Size, N, Out)),
    write(Out, Bytes),
    flush_output(Out).

put(0, _, _) :-
    !.
put(Size, N, Out) :-
    Size1 is Size-1,
    Byte is (N >> (8*Size1)) /\ 255,
    format(Out, "~c", [Byte]),
    put(Size1, N, Out).

check(Bytes, R, S, Check) :-
    hash(Bytes, Hash),
    Check is (Hash + 7919*(R + R//2**19) + 104729*(S + S//2**19)) mod 2**24.

hash("", Hash) :-
    !,
    term_hash("", Hash0),
    Hash is Hash0 mod 2**24.
hash(Text, Hash) :-
    sha_hash(Text, [A, B, C|_], [encoding(octet)]),
    Hash is (A*256+B)*256+C.

%   heard(+Streams, -Frame): the next frame, frame(R, S, Text), which is checked;
%   heard_term(+Streams, -Term): the next term; `end_of_file` at the end.

heard(In-_, Frame) :-
    get(4, 0, In, Length),
    (   Length == end_of_file
    ->  Frame = end_of_file
    ;   get(3, 0, In, Check),
        get(4, 0, In, R),
        get(4, 0, In, S),
        read_string(In, Length, Text),
        check(Text, R, S, Check),
        Frame = frame(R, S, Text)
    ).

get(0, N, _, N) :-
    !.
get(Size, N0, In, N) :-
    get_code(In, Code),
    (   Code == -1
    ->  N = end_of_file
    ;   N1 is N0*256+Code,
        Size1 is Size-1,
        get(Size1, N1, In, N)
    ).

heard_term(Streams, Term) :-
    heard(Streams, Frame),
    (   Frame = frame(_, _, "")
    ->  heard_term(Streams, Term)
    ;   Frame = frame(_, _, Text)
    ->  sub_string(Text, 20, _, 0, Body),
        term_string(Term, Body)
    ;   Term = Frame
    ).

%   The connection is closed; the endpoint may still send before.

heard_end(Streams) :-
    catch(heard_term(Streams, Term), error(io_error(_, _), _),
          Term = end_of_file),
    (   Term == end_of_file
    ->  true
    ;   heard_end(Streams)
    ).

is_answered(Streams, Id) :-
    send(Streams, request(Id, echo, x)),
    heard_term(Streams, Answer),
    assertion(Answer == answer(Id, x)).

notes(Notes) :-
    findall(Note, note(Note), Notes).

                /*******************************
                *            TESTS             *
                *******************************/

:- begin_tests(protocol).

test(smaller_key_counts_first, Count == 0) :-
    served(talking(zz, 0, Streams, Count, is_answered(Streams, 1))).
test(client_with_a_wrong_proof_is_refused, Line == "refused") :-
    served(with_client(In, Out,
        ( greeting(zz, Greeting),
          format(Out, "~w\n00\n", [Greeting]),
          flush_output(Out),
          read_line_to_string(In, _),
          read_line_to_string(In, Line) ))).
test(first_byte_of_no_greeting_ends_the_connection, Byte == -1) :-
    with_settings([typhon_handshake:handshake_time=100],
        served(with_client(In, Out,
            ( format(Out, "G", []),
              flush_output(Out),
              catch(get_code(In, Byte), error(io_error(_, _), _),
                    Byte = -1) )))).
test(frame_that_the_endpoint_cannot_serve_is_answered,
     [ forall(member(Frame-Answers,
                     [ request(7, no_such_kind, x)-[spoilt(7)],
                       request(7, no_hook, x)-[spoilt(7)],
                       hand(no_such_kind, x)-[objection(1, spoilt)],
                       hand(take, no)-[objection(1, no)],
                       hand(take, deferred)-[ objection(1, deferred),
                                              answer(-1, taken(deferred)) ],
                       raw(?, 7, "f((. ")-[spoilt(7)],
                       raw(-, 0, "f((. ")-[objection(1, spoilt)] ])),
       true(Heard == Answers) ]) :-
    served(talking(zz, 0, Streams, _,
                   ( sent(Frame, Streams),
                     heard_terms(Answers, Streams, Heard),
                     is_answered(Streams, 8) ))).
test(accepted_frame_is_settled_and_not_answered, Settled == 1) :-
    served(talking(zz, 0, Streams, _,
                   ( send(Streams, hand(take, accepted)),
                     counted(Streams, 1, Settled) ))).
test(frame_that_is_not_known_is_skipped, Notes == [1, 2]) :-
    served(talking(zz, 0, Streams, _,
                   ( forall(member(Term, [post(note, 1), of_a_later_version(x),
                                          post(no_such_kind, x), bundle(x),
                                          bundle([x]), post(note, 2)]),
                            send(Streams, Term)),
                     is_answered(Streams, 1) ))),
    notes(Notes).
test(frames_that_came_are_counted, Count == 3) :-
    served(( talking(zz, 0, Streams, _,
                     ( send(Streams, post(note, 1)),
                       send(Streams, post(note, 2)),
                       send(Streams, ping),
                       put_frame_to(Streams, 0, 0, ""),
                       is_answered(Streams, 1) )),
             talking(zz, 1, _, Count, true) )).
test(frames_that_the_peer_lacks_are_sent_again,
     [ forall(member(Has-Expected, [ 0-[answer(1, x), answer(2, x), answer(3, y)],
                                     1-[answer(2, x), answer(3, y)],
                                     2-[answer(3, y)] ])),
       true(Heard == Expected) ]) :-
    served(( talking(zz, 0, First, _,
                     ( is_answered(First, 1), is_answered(First, 2) )),
             talking(zz, Has, Second, _,
                     ( send(Second, request(3, echo, y)),
                       heard_terms(Expected, Second, Heard) )) )).
test(each_process_has_a_session_of_its_own, Count == 0) :-
    served(( talking(zz, 0, Streams, _, is_answered(Streams, 1)),
             talking(zy, 0, _, Count, true) )).
test(session_ends_with_bye, Count == 0) :-
    served(( talking(zz, 0, Streams, _,
                     ( is_answered(Streams, 1),
                       send(Streams, bye),
                       heard_end(Streams),
                       wait_until(\+ endpoint_peer('127.0.0.1:1', state(_)),
                                  20) )),
             talking(zz, 0, _, Count, true) )).
test(received_frames_are_counted_on_demand,
     [ forall(member(Kind, [ping, bundle([])])) ]) :-
    served(talking(zz, 0, Streams, _,
                   ( numlist(1, 5, Ns),
                     forall(member(N, Ns), send(Streams, post(note, N))),
                     send(Streams, Kind),
                     counted(Streams, 5, _) ))).
test(received_frames_are_counted_after_32, Counts == [32]) :-
    served(talking(zz, 0, Streams, _,
                   ( counted(Streams, 0, _),
                     forall(between(1, 40, N), send(Streams, post(note, N))),
                     send(Streams, request(1, echo, x)),
                     counts(Streams, Counts) ))).
test(silent_peer_is_pinged_and_then_given_up,
     Heard == [answer(1, x), ping, ping, end_of_file]) :-
    served(with_settings([typhon_reader:silence=0.3],
                         talking(zz, 0, Streams, _,
                                 ( send(Streams, request(1, echo, x)),
                                   heard_terms([_, _, _, _], Streams,
                                               Heard) )))).
test(count_beyond_what_was_sent_ends_the_connection) :-
    served(talking(zz, 0, Streams, _,
                   ( is_answered(Streams, 1),
                     put_frame_to(Streams, 1 000, 0, ""),
                     heard_end(Streams) ))).
test(counts_are_sent_while_a_long_frame_arrives, Count == 0) :-
    served(talking(zz, 0, Streams, _,
                   ( heard(Streams, frame(0, _, "")),
                     Streams = _-Out,
                     put(4, 67 108 864, Out),
                     put(4, 0, Out), put(4, 0, Out), put(3, 0, Out),
                     format(string(Part), "~`xt~65536|", []),
                     write(Out, Part),
                     flush_output(Out),
                     heard(Streams, frame(Count, _, "")) ))).
test(lower_count_is_ignored) :-
    served(talking(zz, 0, Streams, _,
                   ( is_answered(Streams, 1),
                     put_frame_to(Streams, 1, 0, ""),
                     is_answered(Streams, 2) ))).
test(damaged_frame_ends_the_connection_and_is_skipped_the_third_time,
     Heard == [objection(1, spoilt), answer(2, x)]) :-
    served(( forall(between(1, 2, _),
                    talking(zz, 0, Streams, 0,
                            ( damaged(Streams), heard_end(Streams) ))),
             talking(zz, 0, Again, 0,
                     ( damaged(Again),
                       send(Again, request(2, echo, x)),
                       heard_terms([_, _], Again, Heard) )) )),
    notes([]).
test(longer_frame_than_allowed_ends_the_connection) :-
    served(talking(zz, 0, Streams, _,
                   ( Streams = _-Out,
                     Length is 67 108 864+1,
                     put(4, Length, Out),
                     put(4, 0, Out), put(4, 0, Out), put(3, 0, Out),
                     flush_output(Out),
                     heard_end(Streams) ))).

sent(raw(Kind, Id, Body), _-Out) :-
    !,
    frame(Kind, Id, Body, Bytes),
    put_frame(Out, 0, 0, Bytes).
sent(Term, Streams) :-
    send(Streams, Term).

put_frame_to(_-Out, R, S, Bytes) :-
    put_frame(Out, R, S, Bytes).

damaged(_-Out) :-
    frame(-, 0, "post(note,damaged). ", Bytes),
    check(Bytes, 0, 0, Check),
    Wrong is Check xor 1,
    put_frame(Out, 0, 0, Wrong, Bytes).

%   As many terms as are expected.

heard_terms([], _, []).
heard_terms([_|Expected], Streams, [Term|Terms]) :-
    heard_term(Streams, Term),
    heard_terms(Expected, Streams, Terms).

%   counted(+Streams, +Count, -Settled): a head counts so many frames.

counted(Streams, Count, Settled) :-
    heard(Streams, frame(R, S, _)),
    (   R >= Count
    ->  Settled = S
    ;   counted(Streams, Count, Settled)
    ).

%   counts(+Streams, -Counts): of frames without body, until one has a body.

counts(Streams, Counts) :-
    heard(Streams, frame(R, _, Text)),
    (   Text == ""
    ->  Counts = [R|More],
        counts(Streams, More)
    ;   Counts = []
    ).

:- end_tests(protocol).
