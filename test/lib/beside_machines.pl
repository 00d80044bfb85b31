:- module(test_beside_machines,
          [ beside/5,                   % +Options, +Command, -Pid, -Out, :Goal
            machines_permitted/0
          ]).

/** <module> Machines that app/machines.py makes of namespaces

*Threading*: the main thread, with which app/machines.py ends.
*/

:- use_module(common).
:- use_module(library(lists), [append/3]).
:- use_module(library(process),
              [ process_create/3, process_kill/2, process_wait/2,
                process_wait/3 ]).

:- meta_predicate beside(+, +, -, -, 0).

%!  beside(+Options, +Command, -Pid, -Out, :Goal) is semidet.
%
%   Call Goal once while app/machines.py, the process Pid, runs Command, with the
%   output Out, beside the machines of Options; it is killed afterwards.

beside(Options, Command, Pid, Out, Goal) :-
    python(Python),
    project_file('app/machines.py', Program),
    append([Program|Options], Command, Args),
    setup_call_cleanup(
        process_create(Python, Args,
                       [ stdin(null), stdout(pipe(Out)), process(Pid) ]),
        once(Goal),
        ( close(Out),
          catch(end(Pid), error(_, _), true) )).

%   Goal may have seen the end of Pid.

end(Pid) :-
    process_wait(Pid, timeout, [timeout(0)]),
    !,
    process_kill(Pid, kill),
    process_wait(Pid, _).
end(_).

%!  machines_permitted is semidet.
%
%   Prints why, if the system does not permit machines.

machines_permitted :-
    beside([1], [true], Pid, _, wait_for_end(Pid, 60, Status)),
    (   Status == exit(0)
    ->  true
    ;   format(user_error, "% skipped: see the line above~n", []),
        fail
    ).
