:- module(chaos_cluster,
          [ with_cluster/4,             % +Names, +Dir, +Swipl, :Goal
            cluster_names/1,            % -Names
            cluster_running/1,          % -Names
            cluster_hosts/2,            % +Name, -Addresses
            cluster_lives/1,            % -Lives
            cluster_ask/4,              % +Name, +Goal, +Seconds, -Tag
            cluster_result/2,           % +Tag, -Result
            cluster_call/4,             % +Name, +Goal, +Seconds, -Result
            cluster_call_all/3,         % +Goal, +Seconds, -Results
            cluster_wait/1,             % +Stamp
            cluster_answers/1,          % -Answers
            cluster_start/1,            % +Name
            cluster_kill/1,             % +Name
            cluster_signal/2,           % +Name, +Signal
            cluster_proxy/2,            % +Words, -Answer
            cluster_busy/1              % +Seconds
          ]).

/** <module> Processes under attack, and the proxies in front of them

Each process, see chaos_peer, is known by a name, has some hosts, and can be
reached by the others through a proxy only.  A process that was killed and
restarted is another life of the same name; every life has a ledger and a file
of its output.

Each call has a time-out: its result is yes(Goal), `no`, raised(Formal),
`died` if the process was killed meanwhile, or `hung`.

*Threading*: for the main thread.  A thread for each process reads what it
answers, and puts it in the queue `chaos_answers`.
*/

:- use_module('../lib/common', [free_port/1, project_file/2, python/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).

:- meta_predicate with_cluster(+, +, +, 0).

:- dynamic
    place/5,                            % Name, Port, Known, Hosts, Dir
    life/4,                             % Name, Number, From, To
    running/5,                          % Name, Pid, In, Out, Reader
    proxies/3,                          % Pid, In, Out
    busy/1,                             % Pid
    asked/4,                            % Tag, Name, Goal, Deadline
    answered/3,                         % Tag, asked(Name, Goal), Result
    program/1.                          % File

hosts_per_process(3).

%!  with_cluster(+Names, +Dir, +Swipl, :Goal)
%
%   Run Goal once with processes of these Names, which leave their ledgers
%   and messages in Dir.  However it ends, nothing is left running.  Swipl is the
%   program they run.

with_cluster(Names, Dir, Swipl, Goal) :-
    setup_call_cleanup(
        assertz(program(Swipl)),
        ( open_all(Names, Dir), once(Goal) ),
        end_all).

:- initialization(at_halt(chaos_cluster:end_all)).

open_all(Names, Dir) :-
    message_queue_create(_, [alias(chaos_answers)]),
    start_proxies,
    maplist(open_place(Dir), Names),
    maplist(cluster_start, Names).

open_place(Dir, Name) :-
    free_port(Port),
    free_port(Known),
    hosts_per_process(Count),
    findall(Host, ( between(1, Count, I), atom_concat(Name, I, Host) ),
            Hosts),
    assertz(place(Name, Port, Known, Hosts, Dir)),
    cluster_proxy([listen, Name, Known, Port], ok).

%   A suspended process cannot be asked to end, and must not be left
%   suspended.

end_all :-
    forall(retract(running(_, Pid, In, Out, Reader)),
           end_process(Pid, In, Out, Reader)),
    forall(retract(proxies(Pid, In, Out)),
           ( end(Pid), close_pipe(In), close_pipe(Out) )),
    forall(retract(busy(Pid)), end(Pid)),
    retractall(program(_)),
    retractall(place(_, _, _, _, _)),
    retractall(life(_, _, _, _)),
    retractall(asked(_, _, _, _)),
    retractall(answered(_, _, _)),
    catch(message_queue_destroy(chaos_answers), error(_, _), true).

end_process(Pid, In, Out, Reader) :-
    end(Pid),
    close_pipe(In),
    thread_join(Reader, _),
    close_pipe(Out).

end(Pid) :-
    catch(process_kill(Pid, kill), error(_, _), true),
    catch(process_wait(Pid, _), error(_, _), true).

close_pipe(Stream) :-
    catch(close(Stream, [force(true)]), error(_, _), true).

                /*******************************
                *           PROCESSES          *
                *******************************/

%!  cluster_names(-Names) is det.
%!  cluster_running(-Names) is det.
%!  cluster_hosts(+Name, -Addresses) is det.
%!  cluster_lives(-Lives) is det.
%
%   The names of all processes, and of those that run; the addresses of the
%   hosts of one; and life(Name, Number, From, To) for each start of a process;
%   To is `inf` while it lives.

cluster_names(Names) :-
    findall(Name, place(Name, _, _, _, _), Names).

cluster_running(Names) :-
    findall(Name, ( place(Name, _, _, _, _), running(Name, _, _, _, _) ),
            Names).

cluster_hosts(Name, Addresses) :-
    place(Name, _, Known, Hosts, _),
    findall(Address,
            ( member(Host, Hosts),
              format(atom(Address), '~w@127.0.0.1:~d', [Host, Known]) ),
            Addresses).

cluster_lives(Lives) :-
    findall(life(Name, Number, From, To), life(Name, Number, From, To),
            Lives).

%!  cluster_start(+Name) is det.
%
%   Start the process Name, for the first time or again at the same address.

cluster_start(Name) :-
    place(Name, Port, Known, Hosts, Dir),
    aggregate_all(count, life(Name, _, _, _), Before),
    Number is Before+1,
    get_time(Now),
    life_file(Dir, Name, Number, ledger, Ledger),
    life_file(Dir, Name, Number, messages, Messages),
    launch([ '-g', 'chaos_peer:peer', peer, '--',
             ledger=Ledger ],
           Messages, Pid, In, Out),
    thread_create(read_answers(Out, Pid), Reader),
    assertz(running(Name, Pid, In, Out, Reader)),
    assertz(life(Name, Number, Now, inf)),
    cluster_call(Name, open_hosts(Hosts, Port, Known), 60, Result),
    (   Result = yes(_)
    ->  true
    ;   throw(error(system_error(cannot_start(Name, Result)), _))
    ).

life_file(Dir, Name, Number, Extension, File) :-
    format(atom(Base), '~w.~d.~w', [Name, Number, Extension]),
    directory_file_path(Dir, Base, File).

launch(Args0, Messages, Pid, In, Out) :-
    program(Swipl),
    maplist(argument, Args0, Args),
    setup_call_cleanup(
        open(Messages, append, Err),
        process_create(Swipl, Args,
                       [ stdin(pipe(In)), stdout(pipe(Out)),
                         stderr(stream(Err)), process(Pid) ]),
        close(Err)).

argument(peer, File) :-
    !,
    project_file('test/chaos/peer.pl', File).
argument(Name=Value, Argument) :-
    !,
    format(atom(Argument), '--~w=~w', [Name, Value]).
argument(Argument, Argument).

read_answers(Out, Pid) :-
    repeat,
    catch(read_term(Out, Term, []), error(_, _), Term = end_of_file),
    (   Term == end_of_file
    ->  !,
        put_answer(ended(Pid))
    ;   put_answer(Term),
        fail
    ).

put_answer(Term) :-
    catch(thread_send_message(chaos_answers, Term), error(_, _), true).

%!  cluster_kill(+Name) is det.
%
%   Kill the process by SIGKILL.

cluster_kill(Name) :-
    retract(running(Name, Pid, In, Out, Reader)),
    end_process(Pid, In, Out, Reader),
    get_time(Now),
    retract(life(Name, Number, From, inf)),
    assertz(life(Name, Number, From, Now)),
    forall(retract(asked(Tag, Name, Goal, _)),
           assertz(answered(Tag, asked(Name, Goal), died))).

%!  cluster_signal(+Name, +Signal) is det.
%
%   Signal is `stop` or `cont`; no effect on a dead process.

cluster_signal(Name, Signal) :-
    (   running(Name, Pid, _, _, _)
    ->  process_kill(Pid, Signal)
    ;   true
    ).

%!  cluster_busy(+Seconds) is det.
%
%   Keep a processor busy meanwhile; Seconds is an integer.

cluster_busy(Seconds) :-
    format(atom(Command), 'ulimit -t ~d; while :; do :; done', [Seconds]),
    process_create(path(sh), ['-c', Command],
                   [stdin(null), stderr(null), process(Pid)]),
    assertz(busy(Pid)).

                /*******************************
                *             CALLS            *
                *******************************/

%!  cluster_ask(+Name, +Goal, +Seconds, -Tag) is semidet.
%
%   Have Name run Goal; the result is among cluster_answers/1 before long.
%   Fails if Name is dead.

cluster_ask(Name, Goal, Seconds, Tag) :-
    running(Name, _, In, _, _),
    flag(chaos_tag, Tag, Tag+1),
    get_time(Now),
    Deadline is Now+Seconds,
    assertz(asked(Tag, Name, Goal, Deadline)),
    catch(( format(In, '~k.~n', [ask(Tag, Goal)]),
            flush_output(In)
          ),
          error(_, _),
          true).                        % the process hangs or is dead

%!  cluster_result(+Tag, -Result) is det.
%!  cluster_call(+Name, +Goal, +Seconds, -Result) is det.
%!  cluster_call_all(+Goal, +Seconds, -Results) is det.
%
%   Wait for the result, or for all: Name-Result.

cluster_call(Name, Goal, Seconds, Result) :-
    (   cluster_ask(Name, Goal, Seconds, Tag)
    ->  cluster_result(Tag, Result)
    ;   Result = died
    ).

cluster_call_all(Goal, Seconds, Results) :-
    cluster_running(Names),
    findall(Name-Tag,
            ( member(Name, Names), cluster_ask(Name, Goal, Seconds, Tag) ),
            Tags),
    findall(Name-Result,
            ( member(Name-Tag, Tags), cluster_result(Tag, Result) ),
            Results).

cluster_result(Tag, Result) :-
    (   retract(answered(Tag, Asked, Result0))
    ->  Result = Result0,
        (   memberchk(Result, [yes(_),died])
        ->  true
        ;   assertz(answered(-2, Asked, Result))    % to be reported
        )
    ;   asked(Tag, _, _, Deadline),
        get_time(Now),
        Stamp is min(Deadline, Now+1),
        pump(Stamp),
        cluster_result(Tag, Result)
    ).

%!  cluster_wait(+Stamp) is det.
%
%   Take in answers until the time is Stamp.

cluster_wait(Stamp) :-
    repeat,
    get_time(Now),
    (   Now >= Stamp
    ->  !
    ;   Next is min(Stamp, Now+1),
        pump(Next),
        fail
    ).

%   pump(+Stamp): take in one answer, if there is one by then.  A call without
%   an answer in time counts as hung, but not if its answer is still in the
%   queue.

pump(Stamp) :-
    (   thread_get_message(chaos_answers, Message, [deadline(Stamp)])
    ->  take(Message)
    ;   true
    ),
    (   thread_peek_message(chaos_answers, _)
    ->  true
    ;   get_time(Now),
        forall(( asked(Tag, Name, Goal, Deadline), Deadline < Now ),
               ( retractall(asked(Tag, _, _, _)),
                 assertz(answered(Tag, asked(Name, Goal), hung)) ))
    ).

take(answer(Tag, Result)) :-
    (   retract(asked(Tag, Name, Goal, _))
    ->  assertz(answered(Tag, asked(Name, Goal), Result))
    ;   true                            % too late, or killed since then
    ).
take(ended(Pid)) :-
    (   running(Name, Pid, _, _, _)     % and was not killed by us
    ->  cluster_kill(Name),
        get_time(Now),
        assertz(answered(-1, asked(Name, living), crashed(Now)))
    ;   true
    ).

%!  cluster_answers(-Answers) is det.
%
%   answer(Tag, Name, Goal, Result) of all that has come in since the last
%   time; Goal is as it was asked.  A process that ended by itself shows as
%   answer(-1, Name, living, crashed(Time)).

cluster_answers(Answers) :-
    findall(answer(Tag, Name, Goal, Result),
            retract(answered(Tag, asked(Name, Goal), Result)),
            Answers).

                /*******************************
                *            PROXIES           *
                *******************************/

start_proxies :-
    project_file('test/chaos/proxies.py', File),
    python(Python),
    process_create(Python, [File],
                   [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid) ]),
    assertz(proxies(Pid, In, Out)).

%!  cluster_proxy(+Words, -Answer) is det.
%
%   Send a command to the proxies, see proxies.py.

cluster_proxy(Words, Answer) :-
    proxies(_, In, Out),
    atomic_list_concat(Words, ' ', Line),
    format(In, '~w~n', [Line]),
    flush_output(In),
    set_stream(Out, timeout(30)),
    read_term(Out, Answer0, []),
    Answer = Answer0.
