% A study whose runs end in the way that their case says, see test_study_work:
% each writes the id of its process and its case to the file `log` beside it.

study(toy, "A toy").
vary(what, [a, b]).
measure(m, Log, 1) :-
    What = Log.case.what,
    note(Log.case.seed-What),
    format("~w says it~n", [What]),
    work(What).
note(What) :-
    beside(log, File),
    current_prolog_flag(pid, Pid),
    setup_call_cleanup(open(File, append, Out),
        format(Out, "~q.~n", [run(Pid, What)]), close(Out)).
beside(Name, File) :-
    source_file(study_here, Here),
    file_directory_name(Here, Dir),
    atomic_list_concat([Dir, Name], /, File).
study_here.
work(fail) :- !, throw(error(existence_error(luck, here), _)).
work(ball) :- !, throw(ball).
work(kill) :- !, current_prolog_flag(pid, Pid),
    format(atom(Kill), "kill -9 ~d", [Pid]), shell(Kill), work(wait).
work(halt) :- !, halt(7).
work(wait) :- !, thread_get_message(never).
work(stuck) :- !, on_signal(term, _, ignore), work(wait).
work(until) :- !, beside(go, Go), until(Go).
work(_).
until(File) :- exists_file(File), !.
until(File) :- sleep(0.05), until(File).
