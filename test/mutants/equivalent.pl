:- module(test_equivalent,
          [ equivalent_change/2,        % +Change, -Reason
            outdated_equivalent/1       % -File
          ]).

/** <module> Changes that change nothing that can be observed

*Threading*: any thread.
*/

:- use_module('../lib/common', [project_file/2]).
:- use_module(changes, [change_words/3, file_changes/2, plain_head/2]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

%   equivalent(File, Predicate, Kind, Old, New, Reason): Old and New are the
%   words of the text before and after.

equivalent('prolog/typhon/options/quotas/usage.pl', spend_shared/3, goal,
           "once(quota_shared(Host, _, What, _))", "true",
           "acts are counted that no quota bounds").
equivalent('prolog/typhon/options/cell/cells.pl', give/2, goal,
           "key_without_cell(_)", "true",
           "the server of the cells wakes, and finds nothing to do").

equivalent('prolog/typhon/network/saving.pl', must_be_ours/2, cut, "!", "true",
           "what follows raises errors, and does not fail").

equivalent('prolog/typhon/network/log.pl', write_event/4, cut, "!", "true",
           "the server takes the first state that its handler gives").

equivalent('prolog/typhon/options/journal/committing.pl', queue_flush/0, order,
           "queue_flush :- queue(_, _, full), !, wake(now). \c
            queue_flush :- sig_atomic(commit_or_leave)",
           "queue_flush :- sig_atomic(commit_or_leave). \c
            queue_flush :- queue(_, _, full), !, wake(now)",
           "the thread that wants a commit makes it itself, which takes longer").
equivalent('prolog/typhon/options/journal/postgresql.pl', error_words/3, constants,
           "'Can\\'t open lib', 'Data source name'",
           "'Data source name', 'Can\\'t open lib'",
           "any of these words tells the error").
equivalent('prolog/typhon/network/children.pl', secret_made/1, bound,
           "32", "33",
           "a secret may be longer").
equivalent('prolog/typhon/options/cell/cell_frames.pl', unlike_numbers/3, bound,
           "7500", "7501",
           "any character near the middle of a block interrupts its digits").
equivalent('prolog/typhon/kernel/wire/request.pl', unreadable/2, cut, "!", "true",
           "the reader handles each frame once").

equivalent('prolog/typhon/options/identity/birth.pl', birth/3, cut, "!", "true",
           "its caller takes the first birth").

equivalent('experiments/sync/metrics.pl', gaps/1, order,
           "gaps([]). gaps([task(_, _, _, _, _, none)]) :- !",
           "gaps([task(_, _, _, _, _, none)]) :- !. gaps([])",
           "no list of rows matches both").
equivalent('experiments/population/metrics.pl', counts/2, order,
           "counts(created, 1). counts(ended(_), -1)",
           "counts(ended(_), -1). counts(created, 1)",
           "an event of a log, which is ground, matches one of them").

%   bound_argument(File, Predicate, Argument): each caller gives a value there,
%   so the order of clauses for different values does not matter.

bound_argument('prolog/typhon/kernel/base/monotonic.pl', role/2, 1).
bound_argument('prolog/typhon/kernel/wire/kinds.pl', arrives/6, 3).
bound_argument('prolog/typhon/kernel/wire/kinds.pl', ordered/1, 1).
bound_argument('prolog/typhon/kernel/wire/session.pl', session_to_self/1, 1).
bound_argument('prolog/typhon/options/fleet/fleet_journal.pl', must_be_open/5, 1).
bound_argument('prolog/typhon/options/fleet/parking.pl', taken/3, 1).
bound_argument('prolog/typhon/options/guard/allowed.pl', makes_clause/1, 1).
bound_argument('prolog/typhon/options/guard/guard_bodies.pl', guard_construct/4, 1).
bound_argument('prolog/typhon/options/guard/guard_clauses.pl', of_platform/1, 1).
bound_argument('prolog/typhon/options/journal/sql.pl', sql/3, 1).
bound_argument('prolog/typhon/options/migration/strategy.pl', choose/6, 1).
bound_argument('prolog/typhon/options/quotas/quota_enforcer.pl', kept/2, 1).
bound_argument('prolog/typhon/tools/page/browser_orders.pl', run_order/3, 1).
bound_argument('prolog/typhon/tools/page/queries.pl', answer/3, 1).

%   condition(File, Predicate): it is called for one answer, whether any clause
%   holds, and binds nothing.

condition('prolog/typhon/kernel/wire/connection.pl', is_normal_break/1).
condition('prolog/typhon/options/guard/allowed.pl', withheld/1).

%!  equivalent_change(+Change, -Reason:string) is semidet.

equivalent_change(Change, "the messages of two terms in another order") :-
    Change = change(_, _, _, _, order, Name/3, _),
    memberchk(Name, [error_message, message]),
    changed_clauses(Change, (Head1 --> _), (Head2 --> _)),
    Head1 \= Head2.
equivalent_change(Change, "single-sided rules of which no goal matches both") :-
    Change = change(_, _, _, _, order, _, _),
    changed_clauses(Change, (Head1 => _), (Head2 => _)),
    maplist(plain_head, [Head1,Head2], [Plain1,Plain2]),
    Plain1 \= Plain2.
equivalent_change(Change, "clauses for different values of a bound argument") :-
    Change = change(File, _, _, _, order, Predicate, _),
    bound_argument(File, Predicate, Argument),
    changed_clauses(Change, First, Second),
    maplist(argument_of(Argument), [First, Second], [Value1, Value2]),
    Value1 \= Value2.
equivalent_change(Change, "clauses of a condition that binds nothing") :-
    Change = change(File, _, _, _, order, Predicate, _),
    condition(File, Predicate).
equivalent_change(Change, Reason) :-
    Change = change(File, _, _, _, Kind, Predicate, _),
    equivalent(File, Predicate, Kind, _, _, _),
    change_words(Change, Old, New),
    equivalent(File, Predicate, Kind, Old, New, Reason).
equivalent_change(Change, "a cut before an error, which leaves no choice") :-
    Change = change(File, _, End, _, cut, _, _),
    text_after(File, End, After),
    split_string(After, "", " \n", [Next|_]),
    member(Raises, [ throw, existence_error, permission_error, domain_error,
                     type_error, resource_error, instantiation_error ]),
    string_concat(",", Goal0, Next),
    split_string(Goal0, "", " \n", [Goal]),
    sub_string(Goal, 0, _, _, Raises).
equivalent_change(Change, "declarations of a study, which are found by name") :-
    Change = change(File, _, _, _, order, Predicate, _),
    of_study(File),
    memberchk(Predicate, [fixed/3, label/2]).
equivalent_change(Change, "claims of a study, which are listed as they stand") :-
    Change = change(File, _, _, _, order, claim/3, _),
    of_study(File).
equivalent_change(Change, "the line of the thesis that a claim names") :-
    Change = change(File, Start, _, _, bound, claim/3, _),
    of_study(File),
    text_before(File, Start, Before),
    sub_string(Before, _, _, 0, "line(").
equivalent_change(Change, "measures of a study, which are sorted by name") :-
    Change = change(File, _, _, _, order, measure/3, _),
    of_study(File),
    changed_clauses(Change, First, Second),
    maplist(without_cut, [First, Second]).
equivalent_change(Change, "two options of other names, of which one matches") :-
    Change = change(_, _, _, _, order, declared/4, _),
    changed_clauses(Change, First, Second),
    maplist(declared_option, [First, Second], Options),
    maplist(nonvar, Options),
    Options = [Option1, Option2],
    functor(Option1, Name1, _),
    functor(Option2, Name2, _),
    Name1 \== Name2.
equivalent_change(Change, "sides of a comparison that has no direction") :-
    Change = change(_, _, _, _, constants, _, _),
    change_words(Change, Old, New),
    member(Operator, [" =:= ", " =\\= ", " == ", " \\== "]),
    atomic_list_concat([Left, Right], Operator, Old),
    atomic_list_concat([Right, Left], Operator, Exchanged),
    atom_string(Exchanged, New),
    stands_alone(Change).
equivalent_change(Change, "a value that a study assumes, and reports") :-
    Change = change(File, Start, _, _, bound, fixed/3, _),
    of_study(File),
    text_after(File, Start, After),
    once(sub_string(After, Length, _, _, ").\n")),
    sub_string(After, 0, Length, _, Rest),
    once(sub_string(Rest, _, _, _, "assumed(")).
equivalent_change(Change, "a searched list in another order") :-
    Change = change(File, Start, _, _, constants, _, _),
    change_words(Change, Old, _),
    text_before(File, Start, Before),
    searched_list(Before, Old).

argument_of(Number, Clause, Value) :-
    ( Clause = (Head :- _) -> true ; Head = Clause ),
    arg(Number, Head, Value).

without_cut(Clause) :-
    \+ ( sub_term(Goal, Clause), Goal == ! ).

declared_option(typhon_options:declared(_, Option, _, _), Option).

%   stands_alone(+Change): what is changed is a goal or an argument by itself.

stands_alone(change(File, Start, End, _, _, _, _)) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    sub_string(Text, 0, Start, _, Before0),
    sub_string(Text, End, _, 0, After0),
    split_string(Before0, "", " \n", [Before]),
    split_string(After0, "", " \n", [After]),
    sub_atom(Before, _, 1, 0, Left),
    sub_atom(After, 0, 1, _, Right),
    memberchk(Left, ['(', '[', ',']),
    memberchk(Right, [')', ']', ',', '.']).

of_study(File) :-
    sub_atom(File, 0, _, _, 'experiments/').

text_before(File, Start, Before) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    sub_string(Text, 0, Start, _, Before).

text_after(File, End, After) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    sub_string(Text, End, _, 0, After).

%   searched_list(+Before, +Old): Before ends in a list, and Old lies in it, in
%   which memberchk/2 looks for the value of a variable among constants.

searched_list(Before, Old) :-
    sub_string(Before, _, _, After, "memberchk("),
    sub_string(Before, _, After, 0, Call),
    atomic_list_concat([Searched,Elements], '[', Call),
    split_string(Searched, ",", " \n", [Name,""]),
    catch(term_string(Variable, Name), error(syntax_error(_), _), fail),
    var(Variable),
    split_string(Elements, "])(", "", [_]),
    split_string(Old, "[])(", "", [_]).

changed_clauses(change(File, Start, End, _, order, _, _), First, Second) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    Length is End-Start,
    sub_string(Text, Start, Length, _, Clauses0),
    string_concat(Clauses0, ".", Clauses),
    setup_call_cleanup(
        open_string(Clauses, In),
        maplist(read(In), [First, Second]),
        close(In)).

%!  outdated_equivalent(-File) is nondet.
%
%   A change that is said to be equivalent is no longer one of File, or a
%   predicate that is said to be a condition, or called with an argument, has no
%   two clauses.

outdated_equivalent(File) :-
    equivalent(File, Predicate, Kind, Old, New, _),
    project_file(File, Path),
    file_changes(Path, Changes),
    \+ ( member(Change, Changes),
         Change = change(_, _, _, _, Kind, Predicate, _),
         change_words(Change, Old, New) ).
outdated_equivalent(File) :-
    ( bound_argument(File, Predicate, _) ; condition(File, Predicate) ),
    project_file(File, Path),
    file_changes(Path, Changes),
    \+ memberchk(change(_, _, _, _, order, Predicate, _), Changes).
