:- module(test_shell, []).

% The shell commands in the documents run.
%
%   Commands are the lines of indented blocks that begin with a program, and
%   what stands after `$ ` there. Those of one document run in turn, in one
%   copy of the tree, with names of this machine in place of those in the
%   document (names/2). The first command with a program of Prolog is run by the
%   swipl of this machine, further ones by one that has the modules of the tree
%   loaded. How each is run follows from how/2: some serve until the document
%   ends, and long commands only print what they would do (long/2). Commands
%   that need a machine that the suite does not have are in elsewhere/1.

:- use_module('../lib/common').
:- use_module('../lib/documents', [document/1]).
:- use_module('../lib/quick_swipl', [quick_swipl/3]).
:- use_module('../lib/redis', [with_redis/3]).
:- use_module('../lib/texts', [write_file/2, file_lines/2]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [ copy_file/2, delete_directory_and_contents/1,
                directory_file_path/3, make_directory_path/1 ]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

:- needs([core, fleet, journal, openssl, 'page-tools']).

                /*******************************
                *           COMMANDS           *
                *******************************/

%   commands(+File, -Commands): strings, in order.

commands(File, Commands) :-
    file_lines(File, Lines),
    findall(Command, command_in(Lines, Command), Commands).

command_in(Lines, Command) :-
    outside_fences(Lines, Outside),
    commands_of(Outside, "", Commands),
    member(Command, Commands).

outside_fences([], []).
outside_fences([Line|Lines], Outside) :-
    string_concat("```", _, Line),
    !,
    after_fence(Lines, Rest),
    outside_fences(Rest, Outside).
outside_fences([Line|Lines], [Line|Outside]) :-
    outside_fences(Lines, Outside).

after_fence([Line|Lines], Lines) :-
    string_concat("```", _, Line),
    !.
after_fence([_|Lines], Rest) :-
    after_fence(Lines, Rest).

%   commands_of(+Lines, +Cd, -Commands): Cd is "cd DIR && " after a line
%   `cd DIR` of the same block.

commands_of([], _, []).
commands_of([Line|Lines], _, Commands) :-
    \+ string_concat("    ", _, Line),
    !,
    commands_of(Lines, "", Commands).
commands_of([Line|Lines], _, Commands) :-
    string_concat("    cd ", Dir, Line),
    !,
    format(string(Cd), "cd ~s && ", [Dir]),
    commands_of(Lines, Cd, Commands).
commands_of([Line|Lines], Cd, [Command|Commands]) :-
    begins_command(Line, Begin),
    !,
    continued(Begin, Lines, Whole, Rest),
    plain(Whole, Plain),
    string_concat(Cd, Plain, Command),
    commands_of(Rest, Cd, Commands).
commands_of([_|Lines], Cd, Commands) :-
    commands_of(Lines, Cd, Commands).

begins_command(Line, Command) :-
    string_concat("    ", Text, Line),
    \+ sub_string(Text, 0, _, _, " "),
    (   string_concat("$ ", Command, Text)
    ->  true
    ;   Command = Text
    ),
    split_string(Command, " ", "", [Word|_]),
    (   memberchk(Word, ["swipl", "make", "python3", "ssh", "scp", "git",
                         "sudo", "apt", "curl"])
    ->  true
    ;   sub_string(Word, _, _, _, "=")
    ->  sub_string(Command, _, _, _, " swipl ")
    ).

%   Without a comment, and without the `&` of a background command.

plain(Line, Plain) :-
    member(End, [" # ", " & "]),
    string_concat(Line, " ", Line1),
    sub_string(Line1, Before, _, _, End),
    !,
    sub_string(Line, 0, Before, _, Plain0),
    normalize_space(string(Plain), Plain0).
plain(Line, Line).

continued(Begin, [Line|Lines], Command, Rest) :-
    string_concat(Begin0, "\\", Begin),
    !,
    normalize_space(string(More), Line),
    string_concat(Begin0, More, Next),
    continued(Next, Lines, Command, Rest).
continued(Command, Rest, Command, Rest).

                /*******************************
                *          HOW TO RUN          *
                *******************************/

%   how(+Command, -How): the first clause that fits.
%
%     - elsewhere   not here
%     - serves      prints a line, and runs until the document ends
%     - ends(With)  ends with exit status 0, the text With being appended
%     - answers     ends with exit status 0 or 1, as the answer is

how(Command, elsewhere) :-
    elsewhere(Part),
    sub_string(Command, _, _, _, Part),
    !.
how(Command, serves) :-
    serving(Part),
    sub_string(Command, _, _, _, Part),
    \+ sub_string(Command, _, _, _, "--export"),
    !.
how(Command, answers) :-
    sub_string(Command, _, _, _, " diagnose "),
    \+ sub_string(Command, _, _, _, " nxt "),
    !.
how(Command, ends(With)) :-
    long(Part, With),
    sub_string(Command, _, _, _, Part),
    \+ sub_string(Command, _, _, _, "--help"),
    !.
how(_, ends("")).

%   long(?Part, ?With): commands with Part may take minutes or hours (make thesis,
%   demo, bench, chaos; all studies), and are not run: with the option With, make
%   only prints its recipe, and studies and counts their runs; readings have
%   none. An attack has one round.

long("make ", " -n").
long("study.pl -- ", " --list").
long("readings.pl -- ", " --collect").
long("chaos/supervised.pl", " --rounds=1").
long("counts.pl ", " --list").          % test_counts counts

serving("typhon.pl host ").
serving("typhon.pl network ").
serving("typhon.pl page ").
serving("nxt/brick.py ").
serving("examples/applications/").
serving("nxt/world.py ").

elsewhere("COMMAND ... [options]").     % a synopsis
elsewhere("layers.pl -- check").         % a part of make check, see test_make
elsewhere("perf record").               % needs a build of SWI-Prolog with symbols
elsewhere("--speed=0").                 % test_applications runs these
elsewhere("lsp_server").                % a pack that is not part of anything here
elsewhere("db.example").                % test_postgresql has a server
elsewhere("pack_install").              % test_pack installs the pack
elsewhere("swipl pack install").
elsewhere("apt install").
elsewhere("systemctl").
elsewhere("app/machines.py").             % test_several_machines runs it

                /*******************************
                *     NAMES OF THIS MACHINE    *
                *******************************/

%   names(+Dir, -Names): of pairs Shown-Text.

names(Dir, [ "9700"-Port1, "5001"-Port2,
             "/var/lib/typhon"-Dir, "/tmp"-Dir, "/dev/rfcomm0"-Lizzy
           | Names ]) :-
    free_port(Port1),
    free_port(Port2),
    directory_file_path(Dir, lizzy, Lizzy),
    findall(Shown-Text, here(Shown, Text), Names).

here("6379", Port) :-
    engine(Port).
here("redis.example.org", "127.0.0.1").
here("10.0.0.5", "127.0.0.2").
here("10.0.0.7", "127.0.0.3").
here("agents/visitor.pl", "visitor.pl").
here("payloads/repair.pl", "repair.pl").
here(" DIR", " journal").
here("FILE", "extracted").
here("swipl -g \"use_module(library(tartarus", "swipl -p library=prolog \c
                                         -g \"use_module(library(tartarus").

%   The address of a host is replaced by that of the host of this name which a
%   server has printed, and AGENT by an agent of that host.

on_this_machine(Command0, Dir, Names, Command) :-
    findall("AGENT"-Agent, agent_kept(Dir, Agent), Agents),
    append(Agents, Names, All),
    named_here(Command0, All, Command1),
    findall(Address, served_address(Address), Addresses),
    foldl(addressed, Addresses, Command1, Command).

agent_kept(Dir, Agent) :-
    directory_file_path(Dir, agent, File),
    exists_file(File),
    read_file_to_string(File, Text, []),
    normalize_space(string(Agent), Text).

%   named_here(+Shown, +Names, -Text): in one pass, as one text may have the name
%   of another in it.

named_here(Shown, Names, Text) :-
    findall(Before-(Name-Here),
            ( member(Name-Here, Names),
              sub_string(Shown, Before, _, _, Name) ),
            Found),
    keysort(Found, [Before-(Name-Here)|_]),
    !,
    sub_string(Shown, 0, Before, _, Head),
    string_concat(Head, Name, Begin),
    string_concat(Begin, Rest, Shown),
    named_here(Rest, Names, Tail),
    format(string(Text), "~s~w~s", [Head, Here, Tail]).
named_here(Text, _, Text).

served_address(Address) :-
    server(_, File),
    file_lines(File, Lines),
    member(Address, Lines),
    sub_string(Address, _, _, _, "@127.0.0.1:").

addressed(Address, Text0, Text) :-
    split_string(Address, ":", "", [Begin0|_]),
    string_concat(Begin0, ":", Begin),
    sub_string(Text0, Before, Length, _, Begin),
    !,
    sub_string(Text0, 0, Before, _, Head),
    Start is Before+Length,
    sub_string(Text0, Start, _, 0, After0),
    string_codes(After0, Codes),
    without_digits(Codes, After),
    format(string(Text), "~s~s~s", [Head, Address, After]).
addressed(_, Text, Text).

without_digits([Code|Codes], Rest) :-
    code_type(Code, digit),
    !,
    without_digits(Codes, Rest).
without_digits(Rest, Rest).

                /*******************************
                *           RUNNING            *
                *******************************/

%   run_document(+File, -Failed, +Dir): Failed are failed(Command, Why).

run_document(File, Failed, Dir) :-
    commands(File, Commands),
    names(Dir, Names),
    call_cleanup(
        findall(Failure,
                ( member(Command, Commands),
                  failure(Command, Dir, Names, Failure) ),
                Failed),
        end_servers).

failure(Command0, Dir, Names, failed(Command, Why)) :-
    how(Command0, How),
    How \== elsewhere,
    journals_closed(Command0),
    needed_network(Command0, Dir),
    on_this_machine(Command0, Dir, Names, Command),
    run(How, Command, Dir, Why),
    Why \== none.

run(serves, Command, Dir, Why) :-
    serve(Command, Dir, Why).
run(answers, Command, Dir, Why) :-
    ended(Command, Dir, Status, Text),
    (   memberchk(Status, [exit(0), exit(1)]),
        Text \== "",
        \+ sub_string(Text, _, _, _, "Usage")
    ->  Why = none
    ;   Why = Status-Text
    ).
run(ends(With), Command0, Dir, Why) :-
    string_concat(Command0, With, Command),
    ended(Command, Dir, Status, Text),
    (   Status == exit(0)
    ->  Why = none
    ;   Why = Status-Text
    ).

%   programs(+Command, -Bin): the directory of the swipl for Command.

:- dynamic tried/1.                     % Program, as app/typhon.pl

programs(Command, Bin) :-
    program(Command, Program),
    ( tried(Program) ; starts_many(Program) ),
    !,
    quick_programs(Bin).
programs(Command, Bin) :-
    forall(program(Command, Program), assertz(tried(Program))),
    current_prolog_flag(executable, Swipl),
    file_directory_name(Swipl, Bin).

%   starts_many(?Program): processes, each of which would load all from source.

starts_many("bench/run.pl").
starts_many("test/chaos/supervised.pl").

program(Command, Program) :-
    split_string(Command, " ", "", Words),
    member(Program, Words),
    sub_string(Program, _, _, 0, ".pl"),
    !.

%   Output goes to a file: a pipe would delay the end of a server.

ended(Command, Dir, Status, Text) :-
    directory_file_path(Dir, output, File),
    setup_call_cleanup(
        shell_process(Command, Dir, File, Pid),
        wait_for_end(Pid, 100, Status),
        kill_process(Pid)),
    read_file_to_string(File, Text, []).

shell_process(Command0, Dir, File, Pid) :-
    directory_file_path(Dir, bin, Bin),
    programs(Command0, SwiplBin),
    getenv('PATH', Path0),
    atomic_list_concat([Bin, SwiplBin, Path0], :, Path),
    format(atom(Command), '~s', [Command0]),
    setup_call_cleanup(
        open(File, write, Out),
        process_create(path(sh), ['-c', Command],
                       [ stdin(null), stdout(stream(Out)),
                         stderr(stream(Out)), cwd(Dir), process(Pid),
                         detached(true),
                         environment(['PATH'=Path, 'HOME'=Dir]) ]),
        close(Out)).

kill_process(Pid) :-
    catch(process_wait(Pid, Status, [timeout(0)]), error(_, _), Status = gone),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        process_wait(Pid, _)
    ;   true
    ).

                /*******************************
                *            SERVERS           *
                *******************************/

%   serve(+Command, +Dir, -Why): Command runs until end_servers/0, and has
%   printed as many lines as it has hosts.

serve(Command, Dir, Why) :-
    flag(test_shell_server, N, N+1),
    format(atom(Name), 'server~d', [N]),
    directory_file_path(Dir, Name, File),
    string_concat("exec ", Command, Exec),
    shell_process(Exec, Dir, File, Pid),
    assertz(server(Pid, File)),
    expected_lines(Command, Count),
    (   catch(wait_until(has_lines(File, Count), 60), error(_, _), fail)
    ->  Why = none,
        with_journal(Command, Dir, File)
    ;   read_file_to_string(File, Text, []),
        Why = no_output(Text)
    ).

expected_lines(Command, Count) :-
    member(Shape-Count, ["'ring(3)'"-3, "'grid(2,3)'"-6]),
    sub_string(Command, _, _, _, Shape),
    !.
expected_lines(_, 1).

has_lines(File, Count) :-
    file_lines(File, Lines),
    length(Lines, Length),
    Length > Count.

%   There is an agent in each journal.

with_journal(Command, Dir, File) :-
    sub_string(Command, _, _, _, "--journal"),
    !,
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "", [Address|_]),
    format(string(Create),
           "swipl app/typhon.pl create examples/agents/keeper.pl --host ~s",
           [Address]),
    ended(Create, Dir, Status, Id),
    assertion(Status-Id = exit(0)-_),
    directory_file_path(Dir, agent, AgentFile),
    write_file(AgentFile, Id).
with_journal(_, _, _).

%   A running process locks its journal.

journals_closed(Command) :-
    sub_string(Command, _, _, _, "typhon.pl journal "),
    !,
    end_servers.
journals_closed(_).

needed_network(Command, Dir) :-
    sub_string(Command, _, _, _, "n1@127.0.0.1:"),
    \+ server(_, _),
    !,
    serve("swipl app/typhon.pl network 'ring(3)'", Dir, Why),
    assertion(Why == none).
needed_network(_, _).

end_servers :-
    forall(server(Pid, _), process_kill(Pid, int)),
    forall(retract(server(Pid, _)),
           ( wait_for_end(Pid, 30, _),
             kill_process(Pid) )).

:- dynamic server/2.                    % Pid, File

%   The engine of fleets, where the document has some.

:- dynamic engine/1.                    % Port

:- meta_predicate with_engine(+, 0).

with_engine(File, Goal) :-
    commands(File, Commands),
    member(Command, Commands),
    sub_string(Command, _, _, _, "--fleet="),
    !,
    with_redis(['--bind', '127.0.0.1', '127.0.0.2', '--requirepass', secret,
                '--user', lab, on, '>secret', '~*', '+@all'],
               redis(Port, _, _),
               setup_call_cleanup(assertz(engine(Port)), Goal,
                                  retractall(engine(_)))).
with_engine(_, Goal) :-
    call(Goal).

                /*******************************
                *             FILES            *
                *******************************/

%   Copies of the tree for documents are made in one place one after the other,
%   as modules that are loaded before are known by the names of their files.

:- dynamic place/1,                     % Dir, with the folders below
           quick_programs/1.            % Dir

original(Dir) :-
    place_for(original, Dir).

tree(Dir) :-
    place_for(tree, Dir).

place_for(Name, Dir) :-
    place(Place),
    directory_file_path(Place, Name, Dir).

make_place :-
    make_tmp_dir(Place),
    assertz(place(Place)),
    project_file('.', Root),
    original(Original),
    make_directory(Original),
    tree_copy('-Rp', Root, Original),
    place_for(bin, Bin),
    make_directory(Bin),
    with_tree(quick_programs(Bin)).

quick_programs(Bin, Dir) :-
    directory_file_path(Dir, 'test/lib/quick_study.pl', Start),
    quick_swipl(Start, Bin, Quick),
    file_directory_name(Quick, Programs),
    assertz(quick_programs(Programs)).

remove_place :-
    forall(retract(place(Dir)), delete_directory_and_contents(Dir)).

tree_copy(Options, From, To) :-
    directory_files(From, Entries),
    findall(Entry,
            ( member(Entry, Entries),
              \+ memberchk(Entry, [., .., '.git', out]) ),
            Copied),
    append([[Options], Copied, [To]], Args),
    process_create(path(cp), Args, [cwd(From)]).

%   with_tree(:Goal): once(call(Goal, Dir)). Dir is a copy of the tree with links
%   for files, as commands write into other ones (or write the same again, as
%   pictures of doc/). In its bin are scp and ssh of which every target is the
%   directory `there`, and the Python of the system.

:- meta_predicate with_tree(1).

with_tree(Goal) :-
    tree(Dir),
    setup_call_cleanup(
        make_directory(Dir),
        ( prepare(Dir), once(call(Goal, Dir)) ),
        process_create(path(rm), ['-rf', Dir], [])).

prepare(Dir) :-
    original(Original),
    tree_copy('-Rpl', Original, Dir),
    forall(member(Name, [bin, there]),
           ( directory_file_path(Dir, Name, New),
             make_directory_path(New) )),
    forall(file_of(Name, Text),
           ( directory_file_path(Dir, Name, File), write_file(File, Text) )),
    forall(copy_of(Name, From),
           ( directory_file_path(Dir, Name, File),
             project_file(From, Source),
             copy_file(Source, File) )),
    process_create(path(chmod), ['+x', 'bin/ssh', 'bin/scp', 'bin/python3'],
                   [cwd(Dir)]).

file_of('.typhon.cookie', "a cookie of this test").
file_of('program.pl', "p.\n").
file_of('redis.password', "secret\n").
file_of('run.log', "event(0.0,'n1@127.0.0.1:9',none,started).\n").
file_of('bin/python3', "#!/bin/sh\nexec /usr/bin/python3 \"$@\"\n").
file_of('bin/scp', "#!/bin/sh\ncp \"$1\" \"$HOME/there/${2#*:}\"\n").
file_of('bin/ssh', "#!/bin/sh\nshift\ncd \"$HOME/there\" && exec \"$@\"\n").

copy_of('census.pl', 'examples/agents/census.pl').
copy_of('visitor.pl', 'examples/agents/hello.pl').
copy_of('repair.pl', 'payloads/allocation/nearest.pl').
copy_of('my.pl', 'examples/studies/coverage.pl').

:- begin_tests(shell, [setup(make_place), cleanup(remove_place)]).

test(commands_run,
     [ forall(document_with_commands(File)), Failed == [] ]) :-
    with_engine(File, with_tree(run_document(File, Failed))).

%   test_course checks hand-ins as the course does.

document_with_commands(File) :-
    document(File),
    \+ sub_atom(File, _, _, _, '/doc/course/'),
    commands(File, [_|_]).

test(all_names_in_one_pass,
     Text == "host --journal /tmp/9700/alpha --port 17") :-
    named_here("host --journal /var/lib/typhon/alpha --port 9700",
               ["9700"-17, "/var/lib/typhon"-"/tmp/9700", "/tmp"-"/tmp/9700"],
               Text).

test(commands_are_found, Commands == ["make a b", "cd x && swipl y"]) :-
    findall(Command,
            command_in([ "    make a \\", "      b   # c", "    $x", "```",
                         "    make c", "```", "    cd x", "    swipl y",
                         "text" ], Command),
            Commands).

:- end_tests(shell).
