:- module(test_frame, []).

:- use_module('../../../lib/common').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, nth1/4, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon/kernel/wire/frame)).

:- begin_tests(serialization).

test(random_terms, [forall(member(Codec, [text, fast]))]) :-
    set_random(seed(20)),
    forall(between(1, 3000, _),
           ( random_term(4, Term), round_trip(Codec, Term) )).
test(every_special_term, [forall(special(Term))]) :-
    round_trip(text, Term),
    round_trip(fast, Term).
test(shared_variables) :-
    term_bytes(text, f(X, _, g(X), _), Bytes),
    bytes_term(text, Bytes, f(A, B, g(C), D)),
    assertion(A == C),
    assertion(A \== B),
    assertion(B \== D).
test(deep_list) :-
    numlist(1, 100000, List),
    round_trip(text, List),
    round_trip(fast, List).
test(operators_of_the_sender,
     [ setup(op(700, xfx, user:travels)),
       cleanup(op(0, xfx, user:travels)) ]) :-
    term_bytes(text, travels(a, [travels, -, (:-)]), Bytes),
    op(0, xfx, user:travels),
    bytes_term(text, Bytes, Term),
    assertion(Term == travels(a, [travels, -, (:-)])).
test(operators_of_the_receiver,
     [ setup(( op(200, xfy, user:foo), op(200, fy, user:bar) )),
       cleanup(( op(0, xfy, user:foo), op(0, fy, user:bar) )) ]) :-
    Term = f(foo, bar, [foo, bar|foo], bar(foo), foo(bar, bar)),
    round_trip(text, Term).
test(flags_of_both_sides,
     [ forall(member(Flag-Value, [ double_quotes-atom,
                                   back_quotes-string,
                                   float_format-'~2f',
                                   rational_syntax-natural,
                                   character_escapes-false ])),
       setup(flag_or(Flag, '', Old)),
       cleanup(set_prolog_flag(Flag, Old))
     ]) :-
    Term = f("a\nb\\", 'a\nb\\', 1.23456789012345, 1r3, [0'a]),
    term_bytes(text, Term, Plain),
    set_prolog_flag(Flag, Value),
    term_bytes(text, Term, Bytes),
    bytes_term(text, Plain, Again),
    set_prolog_flag(Flag, Old),
    assertion(Bytes == Plain),
    assertion(same(Again, Term)).
test(bytes_are_bytes) :-
    term_bytes(text, 'é\u4e00\U0001F600', Bytes),
    forall(string_code(_, Bytes, Code), assertion(Code =< 255)).
%   The locale determines which letters are written unescaped.

test(quoted_characters) :-
    Term = f('é', "«é", 'é«'(x)),
    term_bytes(text, Term, Bytes),
    findall(Text,
            ( member(E, ["\xc3\\xa9\", "\\u00e9"]),
              format(string(Text), "f('~w',\"\\u00ab~w\",'~w\\u00ab'(x)). ",
                     [E, E, E]) ),
            Texts),
    assertion(( member(Text, Texts),
                sub_string(Bytes, _, _, 0, Text) )),
    round_trip(text, Term).
test(text_of_any_character) :-
    forall(( some_code(Code), char_code(Char, Code) ),
           ( foreign_term(Char, Term), round_trip(text, Term) )).
test(text_is_one_term,
     [ forall(member(More, ["b. ", "b", "% b", " \n", "\u0000"])),
       throws(error(syntax_error(_), _)) ]) :-
    term_bytes(text, a, Bytes),
    string_concat(Bytes, More, Both),
    bytes_term(text, Both, _).
test(fraction, [forall(member(Codec, [text, fast]))]) :-
    round_trip(Codec, 1r3),
    round_trip(Codec, f(-22r7, [1r3])).
test(long_integer_in_a_thread, [forall(member(Codec, [text, fast]))]) :-
    Long is -(7**7000),
    thread_create(round_trip(Codec, f(Long)), Thread),
    thread_join(Thread, Status),
    assertion(Status == true).

:- end_tests(serialization).

hides_variable(X, X).
hides_variable(request(1, hop, f([_,g(X)])), X).
hides_variable(f(Text, X), X) :-
    numlist(1, 5000, Text).

%   unserializable(-Term, -Culprit)

unserializable(agent(x, [a, b(S)]), S) :-
    stream_property(S, alias(user_error)).
unserializable(f(Mutex), Mutex) :-
    mutex_create(Mutex).
unserializable(f(Ref), Ref) :-
    once(clause(special(_), true, Ref)).
unserializable(f(X), _) :-
    freeze(X, true).
unserializable([a, X], f(_)) :-
    X = f(X).

:- begin_tests(unserializable_terms_are_named).

test(unserializable, true(Wrong == [])) :-
    findall(Culprit-Named,
            ( unserializable(Term, Culprit),
              catch(( mobile_term(Term), Named = none ),
                    error(type_error(mobile_term, Named), _), true),
              \+ subsumes_term(Culprit, Named) ),
            Wrong).
test(attributed_variable_in_bytes, [forall(hides_variable(Term, X))]) :-
    freeze(X, throw(woken)),
    fast_term_serialized(Term, Bytes),
    catch(( bytes_term(fast, Bytes, Read), term_variables(Read, [1|_]) ),
          error(Formal, _), true),
    assertion(Formal == type_error(mobile_term, attributed_variable)).
test(encoding_refuses_too, [forall(member(Codec, [fast, text])),
                            error(type_error(mobile_term, Stream))]) :-
    stream_property(Stream, alias(user_error)),
    term_bytes(Codec, f(Stream), _).
test(parts_of_a_tree_are_not_searched_for_cycles, Searches == 1) :-
    numlist(1, 100, Numbers),
    stream_property(Stream, alias(user_error)),
    append(Numbers, [Stream], Term),
    set_flag(searches, 0),
    setup_call_cleanup(
        wrap_predicate(typhon_error_text:is_in_itself(_), counted, Body,
                       ( flag(searches, N, N+1), Body )),
        catch(mobile_term(Term), error(type_error(_, Named), _), true),
        unwrap_predicate(typhon_error_text:is_in_itself/1, counted)),
    assertion(Named == Stream),
    get_flag(searches, Searches).
test(other_terms_can_travel, [forall(special(Term))]) :-
    mobile_term(Term).

:- end_tests(unserializable_terms_are_named).

%   In a separate process, which crashes if atoms are lost.

:- begin_tests(atoms_stay_while_others_are_collected).

:- dynamic readers/1.                   % File: a program

:- prolog_load_context(directory, Dir),
   directory_file_path(Dir, '../../../lib/atoms_collected.pl', File),
   assertz(readers(File)).

test(atoms_of_large_terms_survive_collection,
     Said-Status == "well\n"-exit(0)) :-
    readers(File),
    current_prolog_flag(executable, Swipl),
    setup_call_cleanup(
        process_create(Swipl, [File, '--', 6],
                       [stdout(pipe(Out)), stderr(null), process(Pid)]),
        read_string(Out, _, Said),
        ( close(Out), process_wait(Pid, Status) )).

:- end_tests(atoms_stay_while_others_are_collected).

:- begin_tests(frames_are_counted_bytes).

test(several_frames, Read == ["", "abc", Long, end_of_file]) :-
    all_bytes(Long),
    framed(["", "abc", Long], Bytes),
    read_frames(Bytes, 10000, 4, Read).
test(truncated_in_the_length, error(syntax_error(truncated_frame))) :-
    read_frames("\x0\\x0\", 10000, 1, _).
test(truncated_frame, [forall(member(Cut, [1, 2, 3, 4, 5, 8, 12, 16])),
                       error(syntax_error(truncated_frame))]) :-
    framed(["abc"], Bytes),
    sub_string(Bytes, 0, _, Cut, Short),
    read_frames(Short, 10000, 1, _).
test(damaged, [forall(between(5, 18, At)),
               error(syntax_error(damaged_frame))]) :-
    framed(["abc"], Bytes),             % the check, and the checked bytes
    random_between(0, 7, Bit),
    flipped(At, Bit, Bytes, Damaged),
    read_frames(Damaged, 10000, 1, _).
test(each_flipped_bit_of_a_record) :-
    term_bytes(fast, f(a, "b", [1, 2.0|_]), Body),
    check_bytes(Body, Check),
    string_length(Body, Length),
    forall(( between(1, Length, At), between(0, 7, Bit) ),
           ( flipped(At, Bit, Body, Damaged),
             check_bytes(Damaged, Other),
             assertion(Other =\= Check) )).
test(frame_after_damage, Next == "def") :-
    framed(["abc", "def"], Bytes),
    flipped(16, Bytes, Damaged),
    with_bytes(Damaged, second_frame(Next)).
test(too_long, error(resource_error(frame_bytes))) :-
    framed(["abcd"], Bytes),
    read_frames(Bytes, 3, 1, _).
test(absurdly_long, error(resource_error(frame_bytes))) :-
    read_frames("GET / HTTP/1.1\r\n", 67108864, 1, _).
test(counts_wrap_around, true(Ahead-Counts == 5-counts(1, 0))) :-
    Before is 0xffffffff-3,
    Now is 0xffffffff+2,
    count_ahead(Before, Now, Ahead),
    with_file(write_frames(["x"], counts(0x100000001, 0x300000000)),
              read_frame(10, Counts, "x")).
test(lower_count_is_not_ahead, fail) :-
    count_ahead(10, 9, _).

:- end_tests(frames_are_counted_bytes).

:- begin_tests(unreadable_terms_are_recognized).

test(text, [forall(member(Term-Mark, [request(17, hop, x)-request(17),
                                      answer(0, x)-answer(0)])),
            Found == Mark]) :-
    term_bytes(text, Term, Bytes),
    bytes_mark(Bytes, Found),
    bytes_term(text, Bytes, Again),
    assertion(Again == Term).
test(term_without_a_mark, fail) :-
    term_bytes(text, post(hop, x), Bytes),
    bytes_mark(Bytes, _).
test(long_record, Mark == request(3)) :-
    numlist(1, 100000, Long),
    Term = request(3, hop, Long),
    term_bytes(fast, Term, Bytes),
    bytes_mark(Bytes, Mark),
    bytes_term(fast, Bytes, Again),
    assertion(Again == Term).
test(short_record, fail) :-
    term_bytes(fast, request(3, hop, x), Bytes),
    bytes_mark(Bytes, _).
test(no_record_begins_like_text) :-
    set_random(seed(22)),
    forall(( between(1, 3000, _),
             random_term(4, Term),
             \+ fraction(Term)          % text
           ),
           ( term_bytes(fast, Term, Bytes),
             string_code(1, Bytes, Code),
             assertion(\+ memberchk(Code, `#!`)) )).

:- end_tests(unreadable_terms_are_recognized).

fraction(Term) :-
    rational(Term),
    \+ integer(Term).

flipped(At, Bytes, Damaged) :-
    flipped(At, 0, Bytes, Damaged).

flipped(At, Bit, Bytes, Damaged) :-
    string_codes(Bytes, Codes0),
    nth1(At, Codes0, Code0, Rest),
    Code is Code0 xor (1<<Bit),
    nth1(At, Codes, Code, Rest),
    string_codes(Damaged, Codes).

%   Latin 1, control characters of the writing direction, symbols, and some
%   others.

some_code(Code) :-
    (   between(0, 0x2ff, Code)
    ;   between(0x2000, 0x22ff, Code)
    ;   between(1, 300, I),
        Code is 0x2300 + 401*I,
        \+ between(0xd800, 0xdfff, Code)
    ).

foreign_term(Char, Term) :-
    atom_concat(a, Char, Atom),
    atom_concat(Char, ' \'"\\', Quoted),
    string_concat(Char, '\'"\\', String),
    compound_name_arguments(None, Char, []),
    compound_name_arguments(Two, Char, [Char, [Atom|Quoted]]),
    Term = [Char, Atom, None, Two, -(Two), String|f(_, Char)].

flag_or(Flag, Default, Value) :-
    (   current_prolog_flag(Flag, Value0)
    ->  Value = Value0
    ;   Value = Default
    ).

framed(List, Bytes) :-
    with_file(write_frames(List, counts(7, 5)), read_all(Bytes)).

write_frames(List, Counts, Out) :-
    forall(member(Bytes, List), frame_write(Out, Counts, Bytes)).

read_frame(Max, Counts, Frame, In) :-
    frame_read(In, Max, true, Counts, Frame).

read_all(Bytes, In) :-
    read_string(In, _, Bytes).

write_all(Bytes, Out) :-
    write(Out, Bytes).

read_frames(Bytes, Max, Count, Frames) :-
    length(Frames, Count),
    with_bytes(Bytes, read_each(Frames, Max)).

:- meta_predicate with_bytes(+, 1).

with_bytes(Bytes, Goal) :-
    with_file(write_all(Bytes), Goal).

read_each([], _, _).
read_each([Frame|Frames], Max, In) :-
    frame_read(In, Max, true, Counts, Frame),
    assertion(Frame == end_of_file ; Counts == counts(7, 5)),
    read_each(Frames, Max, In).

second_frame(Frame, In) :-
    catch(frame_read(In, 100, true, _, _), error(syntax_error(_), _), true),
    frame_read(In, 100, true, _, Frame).

%   with_file(:Write, :Read): both are called with a stream of the same bytes.

:- meta_predicate with_file(1, 1), opened(+, +, 1).

with_file(Write, Read) :-
    setup_call_cleanup(
        tmp_file(frame, File),
        ( opened(File, write, Write), opened(File, read, Read) ),
        delete_file(File)).

opened(File, Mode, Goal) :-
    setup_call_cleanup(open(File, Mode, Stream, [type(binary)]),
                       call(Goal, Stream),
                       close(Stream)).

all_bytes(Bytes) :-
    numlist(0, 255, Codes),
    string_codes(Bytes, Codes).

round_trip(Codec, Term) :-
    term_bytes(Codec, Term, Bytes),
    bytes_term(Codec, Bytes, Again),
    (   same(Again, Term)
    ->  true
    ;   throw(error(changed(Codec, Term, Again), _))
    ).

%   nan is not even =@= itself; the records of the bits are.

same(T1, T2) :-
    T1 =@= T2,
    !.
same(T1, T2) :-
    fast_term_serialized(is(T1), Bytes),
    fast_term_serialized(is(T2), Bytes).

special(Term) :-
    member(Term,
           [ [], '[]', '[]'(a), {}, '{}', {a}, '{}'(a, b), foo(), 'a b'(),
             -1, -(1), - a, 1-2, -(-(1)), -(-1), 1 - -1, -(2)^2, 2** -1,
             [+, -, (:-)|(:-)], (:- a), (a:-b, c;d->e), '$VAR'(1),
             '$VAR'('X'), '$VAR'(x), "", '', "s\n\t\\\x01\\"", 'a\nb', 'Aé',
             '\u4e00', "\U0001F600", '.', '|', '|'(a, b), (a|b), !, ;,
             ',', ','(a), ','(a, b, c), [a|b], 'end_of_file', '/*', '%',
             \+a, \ (a), @(x), p:{q}, (dynamic), dynamic(a), table(b), $,
             $(a), `abc`, 'hello world', "it's", 'it''s', a*(b+c)*d,
             1.0Inf, 1.5NaN, 0.1, 1.0e-320, 123456789012345678901234567890,
             -123456789012345678901234567890, 9223372036854775807,
             -9223372036854775808, 1r3, -1r3, 0'a, '\\', '\e', "\x0\",
             a:b:c, [[]], [[], '[]'|'[]'], f(A, _, A), '_'('_'), _, 'X',
             '_x', a=b, [a=b, c:-d], -(a), -[], -({a}), -(-), (-)-(-),
             f((a, b)), f((a:-b)), f(;, '|', (',')) ]).
special(Term) :-
    Term is -inf.
special(Term) :-
    Term is nan.
special(-0.0).
special(Term) :-
    Term is nexttoward(1.0, 2).
special(Term) :-
    Term is 1.0e308*1.7.

random_term(0, Term) :-
    !,
    random_atomic(Term).
random_term(Depth, Term) :-
    random_between(0, 5, Kind),
    (   Kind =< 1
    ->  random_atomic(Term)
    ;   random_between(0, 3, Arity),
        random_name(Name),
        length(Args, Arity),
        Depth1 is Depth-1,
        random_terms(Args, Depth1),
        (   Kind == 2
        ->  Term = Args
        ;   compound_name_arguments(Term, Name, Args)
        )
    ).

random_terms([], _).
random_terms([Term|Terms], Depth) :-
    random_term(Depth, Term),
    random_terms(Terms, Depth).

random_atomic(Term) :-
    random_between(1, 6, Kind),
    random_atomic(Kind, Term).

random_atomic(1, Term) :- random_name(Term).
random_atomic(2, Term) :- random_between(-1000000, 1000000, Term).
random_atomic(3, Term) :- Term is (random_float-0.5)*10.0**(random(600)-300).
random_atomic(4, Term) :- random_name(Name), atom_string(Name, Term).
random_atomic(5, Term) :- specials(Terms), random_member(Term, Terms).
random_atomic(6, _).

random_name(Name) :-
    random_between(0, 5, Kind),
    random_name(Kind, Name).

random_name(0, Name) :-
    operators(Ops),
    random_member(Name, Ops).
random_name(1, Name) :-
    random_member(Name, [a, foo, 'Bar', 'x y', '[]', {}, '', '\\', -]).
random_name(Kind, Name) :-
    Kind > 1,
    random_between(0, 6, Length),
    length(Codes, Length),
    random_codes(Codes),
    atom_codes(Name, Codes).

:- table operators/1, specials/1.

operators(Ops) :-
    findall(Op, ( current_op(P, _, Op), P > 0, Op \== [] ), Ops).

specials(Terms) :-
    findall(Term, special(Term), Terms).

random_codes([]).
random_codes([Code|Codes]) :-
    random_between(0, 9, Kind),
    (   Kind < 7
    ->  random_between(0, 126, Code)
    ;   Kind < 9
    ->  random_between(127, 0xd7ff, Code)
    ;   random_between(0x10000, 0x10ffff, Code)
    ),
    random_codes(Codes).

		 /*******************************
		 *            BUNDLES           *
		 *******************************/

:- meta_predicate with_queue(+, -, 0).

with_queue(Frames, Queue, Goal) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( forall(member(Frame, Frames), thread_send_message(Queue, Frame)),
          once(Goal) ),
        message_queue_destroy(Queue)).

all_that_waits(Queue, Frames) :-
    (   bundle_next(Queue, fast, 100 000, Frame, _)
    ->  Frames = [Frame|More],
        all_that_waits(Queue, More)
    ;   Frames = []
    ).

:- begin_tests(queued_frames).

test(unmarked_frames_are_bundled, true(Many-Left == true-0)) :-
    with_queue([frame("a", loose, 1), frame("b", loose, 2)], Queue,
               ( bundle_next(Queue, fast, 100 000, frame(Bytes, none, 2), Many),
                 message_queue_property(Queue, size(Left)) )),
    fast_term_serialized(Bundle, Bytes),
    bundle_parts(Bundle, Parts),
    assertion(Parts == ["a", "b"]).
test(single_frame_is_not_bundled,
     true(Frames == [ frame("a", none, 1), frame("B", token, 2),
                      frame("c", none, 3) ])) :-
    with_queue([ frame("a", loose, 1), frame("B", token, 2),
                 frame("c", loose, 3) ], Queue,
               all_that_waits(Queue, Frames)).
test(frame_that_does_not_fit_stays, true(Size == 2)) :-
    with_queue([frame("long", none, 0), frame("b", loose, 0)], Queue,
               ( \+ bundle_next(Queue, fast, 3, _, _),
                 message_queue_property(Queue, size(Size)) )).
test(bundle_is_not_longer_than_allowed, true(Size == 1)) :-
    with_queue([ frame("aaaa", loose, 0), frame("bbbb", loose, 0),
                 frame("cccc", loose, 0) ], Queue,
               ( bundle_next(Queue, fast, 30, _, true),
                 message_queue_property(Queue, size(Size)) )).
test(parts_of_a_bundle_have_512_bytes_at_most, Fit == [1, 512]) :-
    findall(Length,
            ( member(Length, [1, 512, 513]),
              format(string(Bytes), "~`xt~*|", [Length]),
              bundle_fits(Bytes) ),
            Fit).
test(bundle_has_at_most_a_hundred_frames, true(Count == 3)) :-
    findall(frame("a", loose, 0), between(1, 250, _), Frames0),
    with_queue(Frames0, Queue,
               ( all_that_waits(Queue, Frames), length(Frames, Count) )).
test(empty_queue, fail) :-
    with_queue([], Queue, bundle_next(Queue, fast, 100 000, _, _)).

:- end_tests(queued_frames).
