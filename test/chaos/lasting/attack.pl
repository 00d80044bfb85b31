:- module(lasting_attack,
          [ lasting/2                   % +Options, -Report
          ]).

/** <module> Processes with journals are killed, again and again

Whatever dies whenever, nobody is lost and nothing happens twice: each agent
ends once with the right count, the counts at the hosts agree with them, each
token is there once, each message has come once, and those of one that stays
in order.

*Threading*: the main thread; each process is looked after by a thread.
*/

:- use_module(agents).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/3, member/2, nth0/3, numlist/3, sum_list/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(random), [random_member/2]).
:- use_module('../../lib/common', [free_port/1]).

:- prolog_load_context(directory, Dir),
   assertz(here(Dir)).

:- dynamic
    here/1,
    child/3,                            % Name, Pid, In
    calm/0,
    deaths/1.

%!  lasting(+Options, -Report) is det.
%
%   Options: dir(Dir), processes(N), agents(N), hops(N) of each, seed(Seed),
%   crash(P) at each step, kill(Seconds) between kills from outside,
%   sync(How), seconds(Limit).  Report is report(Facts, Wrong).

lasting(Options, report(Facts, Wrong)) :-
    option(dir(Dir), Options, _),
    option(processes(Count), Options, 3),
    option(seed(Seed), Options, 1),
    set_random(seed(Seed)),
    retractall(calm),
    retractall(deaths(_)),
    assertz(deaths(0)),
    numlist(1, Count, Numbers),
    maplist(node(Dir, Options), Numbers, Nodes),
    get_time(Start),
    setup_call_cleanup(
        ( maplist(guard, Nodes, Guards),
          host_start(driver) ),
        under_attack(Nodes, Options, Facts0, Wrong),
        ( assertz(calm),
          forall(child(_, Pid, _), catch(process_kill(Pid, kill), _, true)),
          forall(member(Guard, Guards), thread_join(Guard, _)),
          host_stop(driver) )),
    get_time(End),
    Seconds is End-Start,
    deaths(Deaths),
    Facts = [seconds(Seconds), deaths(Deaths)|Facts0].

node(Dir, Options, Number, node(Name, Port, Journal, Sync, P, Address)) :-
    atom_concat(h, Number, Name),
    free_port(Port),
    directory_file_path(Dir, Name, Journal),
    option(sync(Sync), Options, normal),
    option(crash(P), Options, 0.001),
    format(atom(Address), '~w@127.0.0.1:~d', [Name, Port]).

                /*******************************
                *           PROCESSES          *
                *******************************/

guard(Node, Guard) :-
    message_queue_create(Queue),
    thread_create(keep(Node, Queue), Guard),
    thread_get_message(Queue, ready),
    message_queue_destroy(Queue).

%   One that dies is started again.

keep(Node, Queue) :-
    start(Node, Pid, Out),
    (   var(Queue)
    ->  true
    ;   thread_send_message(Queue, ready)
    ),
    process_wait(Pid, _),
    Node = node(Name, _, _, _, _, _),
    retractall(child(Name, _, _)),
    close(Out, [force(true)]),
    (   calm
    ->  true
    ;   with_mutex(lasting, ( retract(deaths(D0)), D is D0+1,
                              assertz(deaths(D)) )),
        keep(Node, _)
    ).

start(node(Name, Port, Dir, Sync, P, _), Pid, Out) :-
    here(Here),
    directory_file_path(Here, 'node.pl', File),
    random_between(1, 1000000, Seed),
    current_prolog_flag(executable, Swipl),
    ( quiet -> Err = null ; Err = std ),
    process_create(Swipl, [File, '--', Name, Port, Dir, Sync, Seed, P],
                   [ stdin(pipe(In)), stdout(pipe(Out)), stderr(Err),
                     process(Pid) ]),
    assertz(child(Name, Pid, In)),
    read_line_to_string(Out, _).

:- dynamic quiet/0.
quiet.

kills(inf) :-
    !.
kills(Seconds) :-
    repeat,
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(Seconds)])
    ->  !
    ;   findall(Pid, child(_, Pid, _), Pids),
        (   Pids \== []
        ->  random_member(Pid, Pids),
            catch(process_kill(Pid, kill), _, true)
        ;   true
        ),
        fail
    ).

                /*******************************
                *             WORK             *
                *******************************/

under_attack(Nodes, Options, [hops(Hops)], Wrong) :-
    option(agents(Agents), Options, 6),
    option(hops(Each), Options, 100),
    option(kill(Seconds), Options, inf),
    option(seconds(Limit), Options, 100),
    findall(Address, member(node(_, _, _, _, _, Address), Nodes), Hosts),
    people(Hosts, Agents, Each, People),
    thread_create(kills(Seconds), Killer),
    get_time(Now),
    Deadline is Now+Limit,
    all_end(People, Deadline, Ends),
    ( catch(thread_send_message(Killer, stop), _, true) ),
    thread_join(Killer, _),
    forall(member(H, Hosts), peace(H)),
    Hops is Agents*Each,
    findall(W, wrong(People, Ends, Hosts, Each, Deadline, W), Wrong).

people(Hosts, Agents, Each, people(Hoppers, Porters, Talkers, Sinks)) :-
    findall(Sink, ( member(H, Hosts), begins(sink, H, [], Sink) ), Sinks),
    findall(A, ( between(1, Agents, I), hopper(I, Hosts, Sinks, Each, A) ),
            Hoppers),
    forall(( member(H, Hosts), between(1, 3, I) ),
           again(remote(H, leave_new(token(H-I))))),
    findall(A, ( member(H, Hosts), turned(H, Hosts, Route),
                 begins(porter, H, [todo(Each), route(Route)], A) ),
            Porters),
    findall(A, ( nth0(I, Hosts, H), length(Hosts, N),
                 J is (I+1) mod N, nth0(J, Sinks, Sink),
                 Words is min(Each, 200),
                 begins(talker, H, [todo(Words), sink(Sink)], A) ),
            Talkers).

hopper(I, Hosts, Sinks, Each, Agent) :-
    length(Hosts, Count),
    J is I mod Count,
    nth0(J, Hosts, Host),
    nth0(J, Sinks, Sink),
    turned(Host, Hosts, Route),
    begins(hopper, Host, [todo(Each), route(Route), sink(Sink)], Agent).

turned(Host, Hosts, Route) :-
    append(Before, [Host|After], Hosts),
    append(After, Before, Others),
    append(Others, [Host], Route),
    !.

%   A creation that was not answered may have been one: those who are not in
%   the books do not count, so it is not tried again while processes die.

begins(Name, Host, Facts, Agent) :-
    program(Name, Program),
    again(agent_create(Program, Agent, [host(Host), facts(Facts)])).

again(Goal) :-
    (   catch(Goal, error(_, _), fail)
    ->  true
    ;   sleep(0.1),
        again(Goal)
    ).

all_end(people(Hoppers, Porters, Talkers, _), Deadline, Ends) :-
    append(Hoppers, Porters, A1),
    append(A1, Talkers, All),
    findall(Agent-End, ( member(Agent, All), ends(Agent, Deadline, End) ),
            Ends).

ends(Agent, Deadline, End) :-
    get_time(Now),
    Left is max(0.1, min(2, Deadline-Now)),
    catch(agent_join(Agent, End0, Left), error(E, _), End0 = error(E)),
    (   End0 \== timeout,
        End0 \= error(_),
        End0 \== unknown
    ->  End = End0
    ;   Now > Deadline
    ->  End = late
    ;   sleep(0.1),
        ends(Agent, Deadline, End)
    ).

peace(Host) :-
    again(remote(Host, ( retractall(lasting_node:probability(_)) ))).

                /*******************************
                *            VERDICT           *
                *******************************/

wrong(_, Ends, _, _, _, ended(Agent, End)) :-
    member(Agent-End, Ends),
    End \== done.
wrong(people(Hoppers, _, _, _), _, _, Each, _, result(Agent, Result)) :-
    member(Agent, Hoppers),
    result_of(Agent, Result),
    Result \== made(Each).
wrong(people(Hoppers, _, _, _), _, Hosts, Each, _, visits(Sum, Expected)) :-
    length(Hoppers, Count),
    Expected is Count*Each,
    findall(V, ( member(H, Hosts), visits(H, V) ), Vs),
    sum_list(Vs, Sum),
    Sum =\= Expected.
wrong(_, _, Hosts, _, _, tokens(Found, Expected)) :-
    findall(T, ( member(H, Hosts), tokens(H, Ts), member(T, Ts) ), Found0),
    msort(Found0, Found),
    findall(H-I, ( member(H, Hosts), between(1, 3, I) ), Expected0),
    msort(Expected0, Expected),
    Found \== Expected.
wrong(people(Hoppers, _, Talkers, Sinks), _, _, Each, Deadline, Wrong) :-
    settled(Sinks, Hoppers, Talkers, Each, Deadline, Facts),
    wrong_mail(Facts, Hoppers, Talkers, Each, Wrong).
wrong(_, _, Hosts, _, _, left(H, Who)) :-
    member(H, Hosts),
    again(remote(H, findall(A-S, ( typhon:agent_property(A, state(S)),
                                   \+ typhon:agent_property(A, program(sink))
                                 ), Who))),
    Who \== [].

result_of(Agent, Result) :-
    again(catch(( agent_result(Agent, Result0, 5) -> true
                ; Result0 = late ),
                error(existence_error(result, _), _), Result0 = none)),
    Result = Result0.

visits(Host, V) :-
    again(remote(Host, findall(X, sense(visits(X)), Vs))),
    sum_list(Vs, V).

tokens(Host, Ts) :-
    again(remote(Host, findall(T, sense(token(T)), Ts))).

settled(Sinks, Hoppers, Talkers, Each, Deadline, Facts) :-
    findall(F, ( member(S, Sinks), facts(S, Fs), member(F, Fs) ), Facts0),
    get_time(Now),
    (   \+ wrong_mail(Facts0, Hoppers, Talkers, Each, _)
    ->  Facts = Facts0
    ;   Now > Deadline
    ->  Facts = Facts0
    ;   sleep(0.2),
        settled(Sinks, Hoppers, Talkers, Each, Deadline, Facts)
    ).

facts(Sink, Facts) :-
    again(agent_property(Sink, facts(Facts))).

wrong_mail(Facts, _, _, _, order(Who, N0, N)) :-
    member(wrong(Who, N0, N), Facts).
wrong_mail(Facts, Hoppers, _, Each, hops(Who, Count-Sum)) :-
    member(Who, Hoppers),
    (   member(hops(Who, Count, Sum), Facts)
    ->  true
    ;   Count = 0, Sum = 0
    ),
    Expected is Each*(Each+1)//2,
    Count-Sum \== Each-Expected.
wrong_mail(Facts, _, Talkers, Each, heard(Who, N)) :-
    member(Who, Talkers),
    ( member(heard(Who, N), Facts) -> true ; N = 0 ),
    N =\= min(Each, 200).
