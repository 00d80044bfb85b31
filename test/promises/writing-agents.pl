%   What doc/writing-agents.md promises, see ../promises.pl.

promise(problem_has_file_and_line, check,
        'prolog/typhon/tools/checks/goal_lines.pl',
        "    line_at(File, Offset, Line),\n\c
         \s   Line >= Line0,\n\c
         \s   !."-
        "    line_at(File, Offset, _), Line = Line0,\n\c
         \s   !.").
promise(all_syntax_errors_are_printed, check,
        'prolog/typhon/tools/checks.pl',
        "problems_of([Error|Errors], _, [Error|Errors], [], [])."-
        "problems_of([Error|_], _, [Error], [], []).").
promise(clauses_that_are_not_together, check,
        'prolog/typhon/tools/checks/warnings.pl',
        "    \\+ memberchk(PI, State),\n\c
         \s   \\+ declared_discontiguous(Directives, PI)."-
        "    \\+ memberchk(PI, State).").
promise(state_may_be_discontiguous, check,
        'prolog/typhon/tools/checks/warnings.pl',
        "    distinct(PI, apart(Rules, PI, Location)),\n\c
         \s   \\+ memberchk(PI, State),"-
        "    State = State, distinct(PI, apart(Rules, PI, Location)),").
promise(undeclared_state_is_a_warning, check,
        'prolog/typhon/tools/checks/warnings.pl',
        "    ;   undeclared_problem(Rules, State, Problem)\n"-
        "").
promise(choices_that_a_stop_discards, check,
        'prolog/typhon/tools/checks/lost_choices.pl',
        "    findall(Choice-PI, member(Choice, Left), Given),"-
        "    findall(Choice-PI, member(sure-Choice, Left), Given0), findall(sure-C, member(C, Given0), Given),").
promise(chosen_clauses_before_fail, check,
        'prolog/typhon/tools/checks/lost_choices.pl',
        "failing(Goal, Left, [sure,other,chosen,maybe]) :-"-
        "failing(Goal, Left, [sure,other,maybe]) :-").
promise(chosen_clauses_before_a_test, check,
        'prolog/typhon/tools/checks/lost_choices.pl',
        "failing(Goal, [], [sure,other]) :-"-
        "failing(Goal, [], [sure,other,chosen]) :-").
promise(cut_discards_on_purpose, check,
        'prolog/typhon/tools/checks/lost_choices.pl',
        "walk(!, _, path(Seen, _, _), path(Seen, [], [])) -->\n\c
         \s   !."-
        "walk(!, _, path(Seen, Left, Lost), path(Seen, Left, Lost)) -->\n\c
         \s   !.").
promise(unknown_predicates_are_warnings, check,
        'prolog/typhon/tools/checks/warnings.pl',
        "    member(call(PI, _), Calls),\n\c
         \s   \\+ memberchk(PI, Own),"-
        "    member(call(PI, run), Calls),\n\c
         \s   \\+ memberchk(PI, Own), fail,").
promise(misspelling_is_proposed, check,
        'prolog/typhon/tools/checks/warnings.pl',
        "    names_near(Name, Sorted, Near)."-
        "    Near = [], Name-Sorted = Name-Sorted.").
promise(warnings_once_for_each_program, check,
        'prolog/typhon/tools/checks/warnings.pl',
        "    warned(Key, Sources, _, _),\n\c
         \s   source_same(Sources),\n\c
         \s   !,\n\c
         \s   fail."-
        "    warned(Key, Sources, _, _),\n\c
         \s   source_same(none),\n\c
         \s   !,\n\c
         \s   fail.").
promise(creation_lists_all_errors, check,
        'prolog/typhon/tools/problem_text.pl',
        "    error_lines(Error),\n\c
         \s   others(Others)."-
        "    error_lines(Error), { Others = Others }.").
