:- module(test_jade,
          [ jade_available/0,
            jade_start/0,
            jade_stop/0,
            jade_url/1,                 % -Url
            jade/2                      % +Words, -Answer
          ]).

/** <module> A JADE platform for tests, in a JVM of its own

Its agents are in fipa/Peer.java, which is compiled when it is started.  It
executes the commands of jade/2 in order.

*Threading*: one test at a time.
*/

:- use_module(common).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

:- dynamic jvm/5.                       % Pid, In, Out, Dir, Url

%!  jade_available is semidet.
%
%   JADE is in Maven's repository of this user.

jade_available :-
    jar(_).

jar(Jar) :-
    project_file('bench/peers/jade', Script),
    setup_call_cleanup(
        process_create(Script, [], [stdout(pipe(Out)), process(Pid)]),
        read_line_to_string(Out, Jar),
        ( close(Out), process_wait(Pid, _) )),
    string(Jar).

%!  jade_start is det.
%!  jade_stop is det.

jade_start :-
    jar(Jar),
    make_tmp_dir(Dir),
    project_file('test/lib/fipa/Peer.java', Source),
    run(javac, ['-nowarn', '-cp', Jar, '-d', Dir, Source]),
    free_port(Mtp),
    other_port(Mtp, Main),
    atomic_list_concat([Dir, Jar], :, Path),
    process_create(path(java),
                   [ '--add-exports',
                     'java.xml/com.sun.org.apache.xerces.internal.jaxp=\c
                      ALL-UNNAMED',
                     '-XX:TieredStopAtLevel=1', '-XX:+UseSerialGC',
                     '-Dfile.encoding=UTF-8', '-Dstdout.encoding=UTF-8',
                     '-cp', Path, 'Peer', Mtp, Main ],
                   [ stdin(pipe(In)), stdout(pipe(Out)), stderr(null),
                     cwd(Dir), process(Pid) ]),
    set_stream(In, encoding(utf8)),
    set_stream(Out, encoding(utf8)),
    set_stream(Out, timeout(60)),
    format(atom(Url), 'http://127.0.0.1:~d/acc', [Mtp]),
    assertz(jvm(Pid, In, Out, Dir, Url)),
    answer(["ok", "ready"]).

other_port(Port, Other) :-
    repeat,
    free_port(Other),
    Other \== Port,
    !.

run(Program, Args) :-
    process_create(path(Program), Args, [stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

jade_stop :-
    retract(jvm(Pid, In, Out, Dir, _)),
    close(In, [force(true)]),
    catch(process_kill(Pid, term), error(_, _), true),
    process_wait(Pid, _),
    close(Out, [force(true)]),
    delete_directory_and_contents(Dir).

%!  jade_url(-Url) is det.

jade_url(Url) :-
    jvm(_, _, _, _, Url).

%!  jade(+Words:list, -Answer:list(string)) is det.

jade(Words, Answer) :-
    jvm(_, In, _, _, _),
    atomic_list_concat(Words, '\t', Line),
    format(In, '~w~n', [Line]),
    flush_output(In),
    answer(Answer).

%   JADE itself prints to this stream, too.

answer(Answer) :-
    jvm(_, _, Out, _, _),
    repeat,
    read_line_to_string(Out, Line),
    (   Line == end_of_file
    ->  throw(error(existence_error(jade, jvm), _))
    ;   split_string(Line, "\t", "", Words),
        Words = [First|_],
        memberchk(First, ["ok", "error"])
    ),
    !,
    Answer = Words.
