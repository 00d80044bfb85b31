:- module(test_cell_frames, []).
:- use_module('../../../lib/common').
:- needs([cells]).
:- use_module('../../../lib/cell_inmate').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon/options/cell/cell_frames),
              [cell_frame_write/2, cell_text_term/2]).
:- use_module(library(typhon)).

/** <module> Frames that no cell should send

*Threading*: one test at a time.
*/

:- begin_tests(cell_frames).

test(forged_frames_are_rejected, Through == []) :-
    findall(Name-test_send(Frame)-ended(lost(cell(Reason))),
            frame(Name, Frame, Reason), Checks),
    with_inmates(through(Checks, Through)).
test(long_texts_are_no_numbers, Wrong == []) :-
    with_hosts([c-[policy(guarded), cell(owner), quota([seconds(60)])]],
               findall(What, ( long_text(What, Codes),
                               \+ comes_back(What, Codes) ), Wrong)).
test(frames_with_long_texts_are_read_back,
     [forall(between(1, 60, _)), Back == Text]) :-
    random_text(Text),
    with_frame(Text, Bytes),
    cell_text_term(Bytes, Back).

:- end_tests(cell_frames).

long_text(digits, [0'7]).
long_text(letters, [0'z]).
long_text(blanks, [0'\s]).
long_text(words, `one two `).
long_text(base, `36'`).

comes_back(What, Part) :-
    create([ (main :- numlist(1, 35000, Ns), findall(C, ( member(_, Ns),
                          member(C, Part) ), Cs),
                      string_codes(S, Cs), result(S-S)) ], A, [host(c)]),
    catch(agent_result(A, S-S, 60), error(_, _), fail),
    string_length(S, Length),
    length(Part, Unit),
    ( Length =:= 35000*Unit -> true ; throw(What) ).

random_text(Text-Atom) :-
    random_between(1, 6, Count),
    length(Runs, Count),
    maplist(run, Runs),
    append(Runs, Codes),
    string_codes(Text, Codes),
    atom_codes(Atom, Codes).

run(Run) :-
    random_between(1, 40 000, Length),
    random_member(Code, `17zaé\s\n'"\\,`),
    length(Run, Length),
    maplist(=(Code), Run).

%   Bytes is the body of the frame of Term.

with_frame(Term, Bytes) :-
    with_output_to(string(Frame), cell_frame_write(current_output, Term)),
    sub_string(Frame, 4, _, 0, Bytes).

%   frame(-Name, -Frame, -Reason): the cell is ended for this Reason.

frame('no term', text("garbage("), violation(syntax_error(_))).
frame('more than a term', text("told(0,[]). told(0,[])."),
      violation(syntax_error(end_of_file_expected))).
frame('a term and half of another', text("told(0,[]). told("),
      violation(syntax_error(end_of_file_expected))).
frame('a term and a comment', text("told(0,[]). % x"),
      violation(syntax_error(end_of_file_expected))).
frame('a term and a byte that is none', text("told(0,[]).\n\000\"),
      violation(syntax_error(end_of_file_expected))).
frame('nothing', text(""), violation(syntax_error(no_term))).
frame('a comment alone', text("% x"), violation(syntax_error(no_term))).
frame('an end that is none', text("end_of_file."),
      violation(syntax_error(no_term))).
frame('no end', bytes([0,0,0,9,0'a]), violation(_)).
frame('longer than any', bytes([255,255,255,255]),
      violation(syntax_error(frame_too_large))).
frame('a record', record(outcome(0, done, none, [])), violation(_)).
frame('half a record', text("\u0083\u0003\u0001"), violation(_)).
frame('too deep', deep(200 000), violation(_)).
frame('a number of many digits', digits("f(a7,", '7', 200 000),
      violation(syntax_error(long_number))).
frame('of base 36', digits("36'", 'z', 100 000),
      violation(syntax_error(long_number))).
frame('of digits with blanks between', digits("", '7 7', 100 000),
      violation(syntax_error(long_number))).
frame('another frame', frame(nonsense), violation(frame)).
frame('a variable', frame(_), violation(frame)).
frame('another turn', outcome_of(-1, done, none, []), violation(frame)).
frame('a turn that is a variable', outcome_of(_, done, none, []),
      violation(frame)).
frame('a request of another turn', frame(request(0, true)), violation(frame)).
frame('acts that are no list', told(x), violation(frame)).
frame('an act that is none', told([1]), violation(frame)).
frame('an act that is a variable', told([_]), violation(frame)).
frame('to lack what it has, again and again', lacks(3), violation(frame)).
frame('the turn before', turn_by(-1), violation(frame)).
frame('the next turn', turn_by(1), violation(frame)).
frame('a limit that a cell does not look at', over(seconds), violation(frame)).
frame('a limit that is none', over(_), violation(frame)).
frame('a record of a clause', record((halt :- true)), violation(_)).
frame('a dictionary', text("told(0,[_{a:1}])."), violation(_)).
frame('an act of a turn that is over', frame(told(0, [log(x)])),
      violation(frame)).
