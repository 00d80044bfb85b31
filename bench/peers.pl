:- use_module(common).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [delete_directory_and_contents/1,
                                 directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, nth1/3, sum_list/2]).
:- use_module(library(process), [process_create/3, process_kill/2,
                                 process_wait/2, process_wait/3]).
:- use_module(library(readutil), [read_file_to_string/3,
                                  read_line_to_string/2]).
:- use_module(library(socket)).

/*  Typhon compared with other platforms, on one machine.

    swipl bench/peers.pl -- Rounds

All are run in turn, Rounds times, each part in a process of its own; the
results are medians, of values and of ratios within a round. Platforms that
are not installed are skipped. The measures are the same for all platforms:

  hops      An agent with 10 facts moves to and fro between two processes; its
            program, of 30 clauses, is there already. One agent, or ten.
  hops_with_program
            The same, with the program.
  trips     A term as long as a hop, without an agent: see peers/hop.pl.
  walks     An agent moves to a random neighbour on 30 hosts, or cells, of one
            process. One agent, or ten.
  answers   An agent creates another in its process, sends it a message and
            waits for the answer; the other then ends. One after the other.
  local, remote
            Two agents send each other a text of 100 characters in turn, in one
            process or in two. Counted is each message. One pair, or ten.
  memory    Resident memory of 10,000 agents that wait for messages, with 10
            facts each: the difference, divided by their number. Of JADE 2,000,
            which have a thread each; of SPADE 100, with a connection each.
  start     From the start of a process until a first answer, as in answers.

Guarantees differ: see the heads of the files in bench/peers, and
doc/performance.md. A part prints a fact, waits for a line, and goes on:

  begin.                  the measurement begins
  done(Measure, Count).   so much was done since
  version(Text).

The time, the processor time and the resident memory of the process and all
its descendants are read here, when a fact has come. */

:- initialization(main, main).

:- dynamic
    value/5,                    % Round, Platform, Measure, Per, Value
    version/2.                  % Platform, Text

main([Argument]) :-
    atom_number(Argument, Rounds),
    setup_call_cleanup(
        ( tmp_file(peers, Dir), make_directory(Dir) ),
        ( findall(Job, job(Dir, Job), Jobs),
          forall(( between(1, Rounds, Round), member(Job, Jobs) ),
                 run(Round, Job)) ),
        delete_directory_and_contents(Dir)),
    forall(measure(Measure, _),
           forall(platform(Platform), reported(Platform, Measure))),
    table(user_error).

                /*******************************
                *           PLATFORMS          *
                *******************************/

%   peer(?Platform, ?Parts, ?Goal): call(Goal, Dir, Command) makes the command
%   line, without the part, or fails if the platform is not installed. Compiled
%   files are in Dir.

peer(typhon, [hops], swipl('hop.pl')).
peer(typhon, [walks,messages,idle,start], swipl('agents.pl')).
peer(erlang, [hops], erlang(hop)).
peer(erlang, [messages,idle,start], erlang(agents)).
peer(jade, [hops], java(jade, 'Hop')).
peer(jade, [messages,idle,start], java(jade, 'Agents')).
peer(pekko, [messages,idle,start], java(pekko, 'Actors')).
peer(spade, [messages,idle,start], python('spade_agents.py')).
peer(mesa, [walks,idle,start], python('mesa_agents.py')).
peer(tartarus, [hops], tartarus).

platform(Platform) :-
    member(Platform, [typhon,erlang,jade,pekko,spade,mesa,tartarus]).

%   job(+Dir, -Job): a part of a platform, job(Platform, Command).

job(Dir, job(Platform, Command)) :-
    peer(Platform, Parts, Goal),
    (   call(Goal, Dir, Words)
    ->  member(Part, Parts),
        append(Words, [Part], Command)
    ;   skipped(Platform)
    ).

skipped(tartarus) :-
    !,
    format(user_error, '% tartarus is skipped: no registry has it; \c
                        TARTARUS=.../platform.pl names a copy~n', []),
    fail.
skipped(Platform) :-
    format(user_error, '% ~w is skipped: make tools-peers~n', [Platform]),
    fail.

swipl(Name, _, [Swipl, File, --]) :-
    current_prolog_flag(executable, Swipl),
    peer_file(Name, File).

tartarus(Dir, Words) :-
    getenv('TARTARUS', File),
    exists_file(File),
    swipl('tartarus.pl', Dir, Words).

%   The nodes find each other without Epmd, which would never end. Their
%   schedulers do not spin: that takes the processor from the other node.

erlang(Module, Dir, [Erl, '+sbwt', none, '-noshell', '-pa', Dir,
                     '-name', 'here@127.0.0.1',
                     '-setcookie', Cookie, '-start_epmd', false,
                     '-erl_epmd_port', Port,
                     '-kernel', inet_dist_use_interface, '{127,0,0,1}',
                     '-run', Module, main, 'there@127.0.0.2', Dir]) :-
    program(erl, Erl),
    program(erlc, Erlc),
    maplist(peer_file, ['hop.erl','agents.erl'], Files),
    completed([Erlc, '-o', Dir|Files]),
    free_port(Port),
    Random is random(1<<64),
    format(atom(Cookie), 'c~16r', [Random]).

java(Jars, Class, Dir0, [Java, '-cp', Path, Class]) :-
    program(java, Java),
    program(javac, Javac),
    first_line(Jars, [], JarPath),
    directory_file_path(Dir0, Jars, Dir),
    atomic_list_concat([Dir, JarPath], :, Path),
    peer_file('.', Sources),
    atom_concat(Class, '.java', Name),
    peer_file(Name, File),
    completed([Javac, '-nowarn', '-cp', JarPath, '-sourcepath', Sources,
               '-d', Dir, File]).

python(Name, _, [Python, '-B', File]) :-
    first_line('../../.ci/peers-python', ['--works'], _),
    first_line('../../.ci/peers-python', ['--where'], Where),
    atom_concat(Where, '/bin/python', Python),
    peer_file(Name, File).

first_line(Script, Args, Line) :-
    peer_file(Script, File),
    setup_call_cleanup(
        process_create(File, Args, [stdout(pipe(Out)), process(Pid)]),
        read_line_to_string(Out, Line),
        ( close(Out), process_wait(Pid, Status) )),
    Status == exit(0).

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

                /*******************************
                *         MEASUREMENTS         *
                *******************************/

%   A part that writes nothing for a minute is killed, with all its processes.

run(Round, job(Platform, [Program|Args])) :-
    get_time(Time),
    process_create(Program, Args,
                   [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid),
                     environment(['ERL_CRASH_DUMP_BYTES'='0']) ]),
    set_stream(Out, timeout(60)),
    catch(facts(used(Time, 0, 0), Round, Platform, Pid, In, Out),
          error(_, _), true),
    ended(Pid, In, Out, Status),
    (   Status == exit(0)
    ->  true
    ;   format(user_error, '% ~w: ~w~n', [[Program|Args], Status])
    ).

ended(Pid, In, Out, Status) :-
    processes(Pid, [_|Others]),
    close(In, [force(true)]),
    close(Out, [force(true)]),
    (   between(1, 200, _),
        process_wait(Pid, Status, [timeout(0)]),
        ( Status == timeout -> sleep(0.1), fail ; true )
    ->  true
    ;   killed(Pid),
        process_wait(Pid, Status)
    ),
    forall(member(Other, Others), killed(Other)).

killed(Pid) :-
    catch(process_kill(Pid, kill), error(_, _), true).

facts(Used, Round, Platform, Pid, In, Out) :-
    read(Out, Fact),
    Fact \== end_of_file,
    !,
    noted(Fact, Pid, Used, Used1, Round, Platform),
    nl(In),
    flush_output(In),
    facts(Used1, Round, Platform, Pid, In, Out).
facts(_, _, _, _, _, _).

noted(version(Text), _, Used, Used, _, Platform) :-
    retractall(version(Platform, _)),
    assertz(version(Platform, Text)).
noted(begin, Pid, _, Used, _, _) :-
    used(Pid, Used).
noted(done(Measure, Count), Pid, Used0, Used, Round, Platform) :-
    used(Pid, Used),
    forall(value(Measure, Count, Used0, Used, Per, Value),
           assertz(value(Round, Platform, Measure, Per, Value))).

value(memory, Count, used(_, _, B0), used(_, _, B), byte, Bytes) :-
    !,
    Bytes is (B-B0)/Count.
value(start, 1, used(T0, C0, _), used(T, C, _), Per, Seconds) :-
    !,
    (   Per = second, Seconds is T-T0
    ;   Per = cpu, Seconds is C-C0
    ).
value(_, Count, used(T0, _, _), used(T, _, _), second, Rate) :-
    Rate is Count/(T-T0).
value(_, Count, used(_, C0, _), used(_, C, _), cpu, Rate) :-
    Rate is Count/max(0.01, C-C0).

%   used(+Pid, -Used): the time, the processor time and the resident memory of
%   a process and its descendants. Linux counts in hundredths of a second, and
%   in pages of 4096 bytes.

used(Pid, used(Time, Seconds, Bytes)) :-
    get_time(Time),
    processes(Pid, Pids),
    findall(S-B, ( member(P, Pids), process_used(P, S, B) ), Each),
    findall(S, member(S-_, Each), Ss),
    findall(B, member(_-B, Each), Bs),
    sum_list(Ss, Seconds),
    sum_list(Bs, Bytes).

processes(Pid, [Pid|Pids]) :-
    format(atom(File), '/proc/~w/task/~w/children', [Pid, Pid]),
    findall(P,
            ( words_of(File, Words), member(Child, Words),
              processes(Child, Some), member(P, Some) ),
            Pids).

%   The name of a program, before the last parenthesis, may have blanks.
%   Children that have ended count.

process_used(Pid, Seconds, Bytes) :-
    format(atom(File), '/proc/~w/stat', [Pid]),
    catch(read_file_to_string(File, Text, []), error(_, _), fail),
    sub_string(Text, Before, _, After, ")"),
    \+ ( sub_string(Text, Other, _, _, ")"), Other > Before ),
    !,
    sub_string(Text, _, After, 0, Rest),
    split_string(Rest, " ", " \n", Words),
    findall(N, ( member(I, [12,13,14,15]), nth1(I, Words, Word),
                 number_string(N, Word) ),
            Ticks),
    sum_list(Ticks, Sum),
    Seconds is Sum/100,
    nth1(22, Words, Pages),
    number_string(Count, Pages),
    Bytes is 4096*Count.

words_of(File, Words) :-
    catch(read_file_to_string(File, Text, []), error(_, _), fail),
    split_string(Text, " ", " \n", Words0),
    findall(N, ( member(W, Words0), number_string(N, W) ), Words).

                /*******************************
                *           FIGURES            *
                *******************************/

%   measure(?Measure, ?Name)

measure(trips(Many), Name) :-
    many(Many, 'bare trips', Name).
measure(hops(Many), Name) :-
    many(Many, hops, Name).
measure(hops_with_program(Many), Name) :-
    many(Many, 'hops with the program', Name).
measure(walks(Many), Name) :-
    many(Many, 'moves in one process', Name).
measure(answers, 'agents created, asked and ended').
measure(local(Many), Name) :-
    many(Many, 'messages in one process', Name).
measure(remote(Many), Name) :-
    many(Many, 'messages between two', Name).
measure(memory, 'memory of an idle agent').
measure(start, 'start, until the first answer').

many(Many, What, Name) :-
    member(Many, [one,ten]),
    atomic_list_concat([What, ', ', Many, ' at a time'], Name).

unit(memory, byte, byte) :-
    !.
unit(start, Per, Unit) :-
    !,
    second_unit(Per, s, 's of processor', Unit).
unit(_, Per, Unit) :-
    second_unit(Per, '1/s', '1/s of processor', Unit).

second_unit(second, Unit, _, Unit).
second_unit(cpu, _, Unit, Unit).

reported(Platform, Measure) :-
    measure(Measure, What),
    forall(median_of(Platform, Measure, Per, Value),
           ( unit(Measure, Per, Unit),
             format(atom(Name), '~w: ~w', [Platform, What]),
             note(Platform, Measure, Per, Note),
             figure(Name, Value, Unit, Note) )).

median_of(Platform, Measure, Per, Median) :-
    member(Per, [second,cpu,byte]),
    findall(Value, value(_, Platform, Measure, Per, Value), Values),
    Values \== [],
    median(Values, Median).

note(Platform, Measure, Per, Note) :-
    (   Platform \== typhon,
        ratio(Platform, Measure, Per, Ratio)
    ->  ratio_text(Ratio, Text),
        format(atom(Note), 'Typhon is ~w times as good', [Text])
    ;   Note = ''
    ).

%   ratio(+Platform, +Measure, +Per, -Ratio): above 1 if Typhon makes more in
%   the same time, or takes less.

ratio(Platform, Measure, Per, Ratio) :-
    ours(Measure, Own),
    findall(R, ( value(Round, Platform, Measure, Per, Theirs),
                 value(Round, typhon, Own, Per, Ours),
                 better(Measure, Ours, Theirs, R) ), Ratios),
    Ratios \== [],
    median(Ratios, Ratio).

ours(hops_with_program(Many), hops(Many)) :-
    !.
ours(Measure, Measure).

better(Measure, Ours, Theirs, Ratio) :-
    memberchk(Measure, [memory,start]),
    !,
    Ratio is Theirs/Ours.
better(_, Ours, Theirs, Ratio) :-
    Ratio is Ours/Theirs.

%   table(+Out): the table of doc/performance.md.

table(Out) :-
    findall(P, ( platform(P), once(value(_, P, _, _, _)) ), Platforms),
    format(Out, '|', []),
    forall(member(P, Platforms),
           ( ( version(P, V) -> true ; V = P ), format(Out, ' | ~w', [V]) )),
    format(Out, ' |~n| ---', []),
    forall(member(_, Platforms), format(Out, ' | ---', [])),
    format(Out, ' |~n', []),
    forall(( measure(M, Name), once(value(_, _, M, _, _)) ),
           ( format(Out, '| ~w', [Name]),
             forall(member(P, Platforms),
                    ( cell(P, M, Cell), format(Out, ' | ~w', [Cell]) )),
             format(Out, ' |~n', []) )).

cell(Platform, Measure, Cell) :-
    findall(Text, ( member(Per, [second,cpu,byte]),
                    cell_part(Platform, Measure, Per, Text) ), Texts),
    atomic_list_concat(Texts, '; ', Cell).

cell_part(typhon, Measure, Per, Text) :-
    !,
    median_of(typhon, Measure, Per, Value),
    (   Value < 100
    ->  format(atom(Text), '~2f', [Value])
    ;   Rounded is round(Value),
        format(atom(Text), '~D', [Rounded])
    ).
cell_part(Platform, Measure, Per, Text) :-
    ratio(Platform, Measure, Per, Ratio),
    ratio_text(Ratio, Text).

ratio_text(Ratio, Text) :-
    Ratio >= 99.5,
    !,
    Rounded is round(Ratio),
    format(atom(Text), '~D', [Rounded]).
ratio_text(Ratio, Text) :-
    format(atom(Text), '~2g', [Ratio]).
