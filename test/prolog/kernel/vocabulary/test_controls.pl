:- module(test_controls, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program),
              [ control/1, control_of_system/1, control_use/2,
                control_written/2, vocabulary_word/2 ]).
:- use_module(library(typhon/options/cell/cell_acts), [cell_outcome/1]).
:- use_module(library(typhon/options/guard/allowed), []).
:- use_module(library(typhon/options/guard/guard_bodies), []).
:- use_module(library(typhon/tools/source_view/variable_names),
              [goals_places/3]).

/** <module> Each control predicate is known wherever one must be

The predicates are those of the table control_use/2.  A test that fails names
the predicates that its part of the library, or a document, does not know.

*Threading*: one test at a time.
*/

indicator(Head, Name/Arity) :-
    functor(Head, Name, Arity).

%   lacking(:Known, -PIs): the control predicates that programs call and of which
%   Known, called with a head, is false.

:- meta_predicate lacking(1, -).

lacking(Known, PIs) :-
    findall(PI, ( control_use(Head, called(_)), \+ call(Known, Head),
                  indicator(Head, PI) ), PIs).

has_effect(Head) :-
    \+ \+ ( clause(typhon_effect:effect(Head0, _, _, _, _), _),
            nonvar(Head0),
            Head0 = Head ).

is_word(Head) :-
    indicator(Head, PI),
    (   vocabulary_word(_, PI)
    ->  true
    ;   control_of_system(Head)
    ).

%   documented(+Head): doc/agents.md names the predicate, or has a call of it.

documented(Head) :-
    project_file('doc/agents.md', File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    functor(Head, Name, Arity),
    between_pieces(Text, Piece),
    catch(term_string(Term, Piece), error(_, _), fail),
    names(Term, Name/Arity),
    !.

names(Name/Arity, PI) =>
    PI = Name/Arity.
names(Call, PI), callable(Call) =>
    functor(Call, Name, Arity),
    PI = Name/Arity.
names(_, _) =>
    fail.

between_pieces(Text, Piece) :-
    split_string(Text, "`", "", Pieces),
    member(Piece0, Pieces),
    string_length(Piece0, Length),
    Length < 80,
    split_string(Piece0, "?", "", Parts),   % a mode is no operator
    atomics_to_string(Parts, Piece).

%   displayed(+File, +Head): File, which colours programs, has the name.

displayed(Relative, Head) :-
    project_file(Relative, File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    functor(Head, Name, _),
    split_string(Text, "|:()\"", "", Words),
    atom_string(Name, Word),
    memberchk(Word, Words).

passes(Head) :-
    (   control_of_system(Head)
    ->  true
    ;   typhon_guard_bodies:passes(Head)
    ).

outcome(Control) :-
    cell_outcome(effect(Control, _, [])).

%   in_time(?Control): where it has a time, that is a number.

in_time(Control) :-
    control_use(Control, Use),
    ( Use = waits(_, Until) -> Until = 1.5 ; true ).

refused(Written, Head) :-
    functor(Written, Name, Arity),
    functor(General, Name, Arity),
    setup_call_cleanup(
        assertz(typhon_allowed:rule(General, test_controls, refuse), Ref),
        typhon_allowed:refuses(test_controls, Head),
        erase(Ref)),
    !.

:- begin_tests(controls).

test(each_has_an_effect, Missing == []) :-
    findall(PI, ( control_use(Head, _), \+ has_effect(Head),
                  indicator(Head, PI) ), Missing).
test(each_effect_is_of_a_control_predicate, Unknown == []) :-
    findall(PI, ( clause(typhon_effect:effect(Head, _, _, _, _), _),
                  nonvar(Head), \+ control(Head), indicator(Head, PI) ),
            Unknown).
test(agents_find_each, Missing == []) :-
    lacking(is_word, Missing).
test(each_raises_an_error_where_an_agent_cannot_stop, Silent == []) :-
    findall(PI, ( control_use(Head, called(_)),
                  \+ control_of_system(Head),
                  indicator(Head, PI),
                  \+ catch(( typhon_words:Head, fail ),
                           error(permission_error(call, control_predicate,
                                                  PI), _), true) ),
            Silent).
test(written_form_is_a_control_predicate, Wrong == []) :-
    findall(PI, ( control_written(Head, Written),
                  \+ control_use(Written, called(_)),
                  indicator(Head, PI) ), Wrong).
test(cells_may_stop_at_each, Refused == []) :-
    findall(PI, ( control_use(Control, Use),
                  ( Use = called(_) ; Use = waits(_, _) ),
                  in_time(Control), \+ outcome(Control),
                  indicator(Control, PI) ), Refused).
test(cells_stop_at_no_other, Taken == []) :-
    findall(PI, ( control_use(Control, Use),
                  ( Use = restored(_) ; Use == kernel ; Use = waits(_, no) ),
                  outcome(Control), indicator(Control, PI) ), Taken).
test(guard_lets_each_stop_the_agent, Refused == []) :-
    lacking(passes, Refused).
test(rule_refuses_what_its_predicate_becomes, Passed == []) :-
    findall(PI, ( control_written(Head, Written),
                  \+ refused(Written, Head), indicator(Head, PI) ), Passed).
test(rule_refuses_no_other, Refused == []) :-
    findall(PI-Of, ( control(Head), control_use(Written, called(_)),
                     Written \= Head, \+ control_written(Head, Written),
                     Written-Head \= move(_)-move(_, _),
                     refused(Written, Head), indicator(Head, PI),
                     indicator(Written, Of) ), Refused).
test(waiting_agent_is_found_in_its_clause, Lost == []) :-
    findall(PI, ( control_written(Head, Written),
                  \+ goals_places([(main:-a,Written,b),(p:-c)], [Head,b],
                                  [1-2]),
                  indicator(Head, PI) ), Lost).
test(documents_have_each, Missing == []) :-
    lacking(documented, Missing).
test(editors_display_each, Missing == []) :-
    aggregate_all(bag(File-PIs),
                  ( member(File, [ 'app/editors/emacs/typhon.el',
                                   'app/editors/vscode/syntaxes/\c
                                    prolog.tmLanguage.json' ]),
                    lacking(displayed(File), PIs), PIs \== [] ), Missing).

:- end_tests(controls).
