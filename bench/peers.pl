:- use_module(common).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module(trip, [trip_bytes/1]).
:- use_module(library(filesex), [delete_directory_and_contents/1,
                                 directory_file_path/3]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module(library(process), [process_create/3, process_kill/2,
                                 process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket)).
:- use_module(library(solution_sequences), [distinct/2]).

/*  Our hops compared with other platforms, between two processes of one
    machine: the bare trip of the same bytes, Erlang and JADE.

    swipl bench/peers.pl -- Rounds

All are run in turn, Rounds times; the results are medians, of rates and of
ratios within a round.  Rates are those of one traveller and of ten at once, by
the clock and by the processor time of both processes.  The payload and the
guarantees differ: see the heads of the files in bench/peers.  Platforms that
are not installed are skipped. */

:- initialization(main, main).

:- dynamic
    rates/5,                    % Round, What, Many, PerSecond, PerCpu
    bytes/2.                    % What, Bytes

main([Argument]) :-
    atom_number(Argument, Rounds),
    setup_call_cleanup(
        ( tmp_file(peers, Dir), make_directory(Dir) ),
        ( findall(Command, command(Dir, Command), Commands),
          forall(( between(1, Rounds, Round), member(Command, Commands) ),
                 run(Round, Command)) ),
        delete_directory_and_contents(Dir)),
    forall(distinct(What-Bytes, bytes(What, Bytes)),
           ( atom_concat('bytes sent at a time, ', What, Name),
             figure(Name, Bytes, byte) )),
    forall(member(Many, [one, ten]), reported(Many)).

                /*******************************
                *            PEERS             *
                *******************************/

%   command(+Dir, -Command): a list of words, a command that prints facts
%   rates(What, Many, PerSecond, PerCpu) and bytes(What, Bytes). Compiled files
%   are in Dir.

command(_, [Swipl, File]) :-
    current_prolog_flag(executable, Swipl),
    peer_file('hop.pl', File).
command(Dir, Command) :-
    peer(Name, Goal),
    (   call(Goal, Dir, Command)
    ->  true
    ;   format(user_error, '% ~w is skipped: make tools-peers~n', [Name]),
        fail
    ).

peer('Erlang', erlang).
peer('JADE', jade).

%   The nodes find each other without Epmd, which would never end. Their
%   schedulers do not spin: that takes the processor from the other node.

erlang(Dir, [Erl, '+sbwt', none, '-noshell', '-pa', Dir,
             '-name', 'here@127.0.0.1',
             '-setcookie', Cookie, '-start_epmd', false,
             '-erl_epmd_port', Port,
             '-kernel', inet_dist_use_interface, '{127,0,0,1}',
             '-run', hop, main, 'there@127.0.0.2', Dir, Bytes]) :-
    program(erl, Erl),
    program(erlc, Erlc),
    peer_file('hop.erl', File),
    completed([Erlc, '-o', Dir, File]),
    free_port(Port),
    Random is random(1<<64),
    format(atom(Cookie), 'c~16r', [Random]),
    trip_bytes(Bytes).

jade(Dir, [Java, '-cp', Path, 'Hop']) :-
    program(java, Java),
    program(javac, Javac),
    jar(Jar),
    peer_file('Hop.java', File),
    completed([Javac, '-cp', Jar, '-d', Dir, File]),
    atomic_list_concat([Dir, Jar], :, Path).

jar(Jar) :-
    peer_file(jade, Script),
    setup_call_cleanup(
        process_create(Script, [], [stdout(pipe(Out)), process(Pid)]),
        read_line_to_string(Out, Jar),
        ( close(Out), process_wait(Pid, _) )),
    string(Jar).

program(Name, File) :-
    absolute_file_name(path(Name), File,
                       [access(execute), file_errors(fail)]).

peer_file(Name, File) :-
    source_file(main(_), Here),
    atom_concat(Base, '.pl', Here),
    directory_file_path(Base, Name, File).

completed([Program|Args]) :-
    process_create(Program, Args, [process(Pid)]),
    process_wait(Pid, exit(0)).

free_port(Port) :-
    tcp_socket(Socket),
    tcp_bind(Socket, '127.0.0.1':Port),
    tcp_close_socket(Socket).

%   A peer that writes nothing for two minutes is killed.

run(Round, [Program|Args]) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(pipe(Out)), process(Pid),
                     environment(['ERL_CRASH_DUMP_BYTES'='0']) ]),
    set_stream(Out, timeout(120)),
    call_cleanup(catch(noted(Round, Out), error(_, _),
                       process_kill(Pid, term)),
                 close(Out, [force(true)])),
    process_wait(Pid, Status),
    (   Status == exit(0)
    ->  true
    ;   format(user_error, '% ~w: ~w~n', [Program, Status])
    ).

noted(Round, Out) :-
    repeat,
    read(Out, Term),
    note(Term, Round),
    Term == end_of_file,
    !.

note(rates(What, Many, PerSecond, PerCpu), Round) :-
    assertz(rates(Round, What, Many, PerSecond, PerCpu)).
note(bytes(What, Bytes), _) :-
    assertz(bytes(What, Bytes)).
note(end_of_file, _).

                /*******************************
                *           FIGURES            *
                *******************************/

reported(Many) :-
    findall(What, rates(_, What, Many, _, _), Whats0),
    list_to_set(Whats0, Whats),
    forall(member(What, Whats),
           ( report(What, Many, second), report(What, Many, cpu) )).

report(What, Many, Per) :-
    findall(Rate, rate(_, What, Many, Per, Rate), Rates),
    median(Rates, Median),
    unit(Per, Unit),
    format(atom(Name), '~w, ~w at a time, per ~w', [What, Many, Unit]),
    against(What, Many, Per, Note),
    figure(Name, Median, '1/s', Note).

unit(second, second).
unit(cpu, 'CPU second').

against('our hops', _, _, '') :-
    !.
against(What, Many, Per, Note) :-
    findall(Ratio,
            ( rate(Round, What, Many, Per, Theirs),
              rate(Round, 'our hops', Many, Per, Ours),
              Ratio is Ours/Theirs ),
            Ratios),
    median(Ratios, Median),
    format(atom(Note), 'our hops against ~w: ~2g times', [What, Median]).

rate(Round, What, Many, second, Rate) :-
    rates(Round, What, Many, Rate, _).
rate(Round, What, Many, cpu, Rate) :-
    rates(Round, What, Many, _, Rate).
