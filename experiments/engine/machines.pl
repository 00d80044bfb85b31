:- module(study_machines,
          [ beside_machines/2,          % +Options, -Status
            machines/3                  % +Options, -Here, -Machines
          ]).
:- use_module(library(lists), [append/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).

/** <module> The machines of --machines

--machines names targets of ssh. A number makes so many machines: this program
is then run again by app/machines.py, in whose environment they are named.

*Threading*: the main thread.
*/

:- multifile
    prolog:error_message//1,
    prolog:message//1.

%!  machines(+Options, -Here:atom, -Machines:list(atom)) is semidet.
%
%   The machines reach this process at the interface Here. Fails without
%   --machines.
%
%   @error study_machines(no_bind) if --bind is missing

machines(Options, Here, Machines) :-
    option(machines(Text), Options),
    (   wanted(Text, _)
    ->  getenv('TYPHON_MACHINES', Names),
        getenv('TYPHON_BIND', Here)
    ;   option(bind(Here), Options)
    ->  Names = Text
    ;   throw(error(study_machines(no_bind), _))
    ),
    atomic_list_concat(Machines, ',', Names).

%!  beside_machines(+Options, -Status) is semidet.
%
%   If --machines is a number, run this program again beside so many machines,
%   until it ends with Status. The n-th machine delays packets by n/2 ms, and
%   loses n/10 % of them. Fails if there is nothing to make, or if the system
%   does not permit machines, after a warning.

beside_machines(Options, Status) :-
    option(machines(Text), Options),
    wanted(Text, Count),
    \+ getenv('TYPHON_MACHINES', _),
    module_property(study_machines, file(Here)),
    absolute_file_name('../../app/machines.py', Program, [relative_to(Here)]),
    lasting(Count, 2, Delays),
    lasting(Count, 10, Losses),
    current_prolog_flag(os_argv, [_|Argv]),
    current_prolog_flag(executable, Swipl),
    append([Program, '--delay', Delays, '--loss', Losses, Count, Swipl], Argv,
           Args),
    ends(path(python3), Args, Status),
    (   Status =:= 69
    ->  print_message(warning, study_machines(none)),
        fail
    ;   true
    ).

wanted(Text, Count) :-
    atom_number(Text, Count),
    integer(Count).

lasting(Count, Divisor, Text) :-
    findall(Value, ( between(1, Count, N), Value is N/float(Divisor) ), Values),
    atomic_list_concat(Values, ',', Text).

ends(Program, Args, Status) :-
    setup_call_cleanup(
        process_create(Program, Args, [process(Pid)]),
        process_wait(Pid, Ended),
        ( var(Ended) -> process_kill(Pid, term), process_wait(Pid, _) ; true )),
    (   Ended = exit(Status)
    ->  true
    ;   Ended = killed(Signal),
        Status is 128 + Signal
    ).

prolog:message(study_machines(none)) -->
    [ '--machines: the runs on machines are left out'-[] ].
prolog:error_message(study_machines(no_bind)) -->
    [ '--machines: add --bind ADDRESS, at which the machines reach this one'-[] ].
