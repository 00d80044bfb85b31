:- module(chaos_work,
          [ work_begin/1,               % +Scale
            work_event/1,               % +Event
            work_answers/0,
            work_halt/0,
            work_roll_call/0,
            work_agents/1,              % -Agents
            work_mail/1,                % -Mail
            work_disposed/1,            % -Pairs
            work_calls/1                % -Calls
          ]).

/** <module> The work of the agents during an attack

Creates the agents, and carries out the events of the schedule that concern
them:

  | sprint(P, Journeys)   | a sprinter sets out from P, another waits for it |
  | victim(P, Program)    | one sets out that is disposed of before long     |
  | dispose(Q)            | Q, a process or `any`, disposes of the oldest one|
  | settlers(P)           | P was restarted: travellers are created there    |
  | order(P, X)           | P tells a sleeper to go somewhere                |
  | look(P, X)            | P asks where an agent is                         |
  | tell(P, X)            | P writes to an agent                             |

X, a number from 0 to 1, selects the agent.  Nothing here waits for a process
while the schedule runs.

*Threading*: for the main thread.
*/

:- use_module('../lib/common', [project_file/2]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists),
              [append/2, append/3, member/2, nth0/3, numlist/3, select/3]).
:- use_module(library(random), [random_permutation/2]).
:- use_module(cluster).

:- dynamic
    agent/5,                            % Key, Kind, Id, Life, Time
    number/2,                           % Kind, Number
    victim/3,                           % Key, Id, Tries: to be disposed of
    disposed/2,                         % Key, Time
    doing/2,                            % Tag, What
    posted/3,                           % Sender, Key, Number
    sent/4,                             % Sender, Key, Number, Asked: certainly
    failure/3.                          % What, Name, Result

%   population(?Kind, ?Program, -Share, -Facts): Share is a percentage.

population(traveller, traveller, 30, []).
population(rover,     chatter,   24, [restless(true)]).
population(sitter,    chatter,   12, [restless(false)]).
population(heavy,     heavy,      6, [load(3000)]).
population(cloner,    cloner,     8, [made(0)]).
population(sleeper,   sleeper,   20, []).

friends(3).
tokens_on_a_host(3).

call_seconds(45).

                /*******************************
                *          BEGINNING           *
                *******************************/

%!  work_begin(+Scale) is det.
%
%   Start about Scale agents, spread over all processes, give them tokens
%   and introduce them to each other.

work_begin(Scale) :-
    clear,
    cluster_names(Names),
    forall(population(Kind, Program, Share, Facts),
           ( Count is max(2, round(Scale*Share/100)),
             numlist(1, Count, Numbers),
             maplist(begin(Kind, Program, Facts, Names), Numbers)
           )),
    await_all,
    leave_tokens,
    introduce,
    await_all.

clear :-
    forall(member(Fact, [ agent(_, _, _, _, _), number(_, _), victim(_, _, _),
                          disposed(_, _), doing(_, _), posted(_, _, _),
                          sent(_, _, _, _), failure(_, _, _) ]),
           retractall(Fact)).

%   Travellers begin with a token each.  Those on the hosts have numbers
%   above 0.

begin(Kind, Program, Facts0, Names, Number) :-
    length(Names, Count),
    I is Number mod Count,
    nth0(I, Names, Name),
    (   Kind == traveller
    ->  Token is -Number,
        Facts = [token(Token)|Facts0]
    ;   Facts = Facts0
    ),
    set_out(Name, Kind, Program, Facts).

leave_tokens :-
    tokens_on_a_host(Each),
    forall(( all_hosts(Hosts), nth0(I, Hosts, Host), at(Host, Name) ),
           ( From is I*Each+1,
             To is From+Each-1,
             ask(Name, remote(Host, forall(between(From, To, K),
                                           leave(token(K)))), leave)
           )).

at(Host, Name) :-
    cluster_names(Names),
    member(Name, Names),
    cluster_hosts(Name, Hosts),
    memberchk(Host, Hosts).

introduce :-
    findall(Key-Id,
            ( agent(Key, Kind, Id, _, _), memberchk(Kind, [rover,sitter]) ),
            Chatters),
    friends(Count),
    forall(select(Key-Id, Chatters, Others),
           ( random_permutation(Others, Mixed),
             length(Friends, Count),
             append(Friends, _, Mixed),
             agent(Key, _, Id, Name-_, _),
             ask(Name, agent_send(Id, friends(Friends)), introduce) )).

%   set_out(+Name, +Kind, +Program, +Facts): an agent of that Kind, on a
%   host of the process Name.

set_out(Name, Kind, Program, Facts) :-
    next_number(Kind, N),
    atom_concat(Kind, N, Key),
    all_hosts(Hosts),
    cluster_hosts(Name, Mine),
    length(Mine, Count),
    I is N mod Count,
    nth0(I, Mine, Host),
    common_facts(Program, Key, Hosts, Common),
    append(Common, Facts, All),
    format(atom(Relative), 'test/chaos/agents/~w.pl', [Program]),
    project_file(Relative, File),
    ask(Name, agent_create(File, _, [host(Host), name(Key), facts(All)]),
        create(Key, Kind)).

common_facts(sprinter, Key, Hosts,
             [me(Key), tick(0), steps(0), hosts(Hosts)]) :-
    !.
common_facts(_, Key, Hosts,
             [me(Key), tick(0), steps(0), hosts(Hosts), heard(0)]).

next_number(Kind, N) :-
    (   retract(number(Kind, N0))
    ->  true
    ;   N0 = 0
    ),
    N is N0+1,
    assertz(number(Kind, N)).

all_hosts(Hosts) :-
    cluster_names(Names),
    maplist(cluster_hosts, Names, Lists),
    append(Lists, Hosts).

                /*******************************
                *            EVENTS            *
                *******************************/

%!  work_event(+Event) is semidet.
%
%   Fails if Event is none of the above.

work_event(sprint(P, Journeys)) :-
    set_out(P, sprinter, sprinter, [journeys(Journeys)]).
work_event(victim(P, heavy)) :-
    set_out(P, victim, heavy, [load(3000)]).
work_event(victim(P, sprinter)) :-
    set_out(P, victim, sprinter, [journeys(1 000 000)]).
work_event(dispose(Q)) :-
    (   retract(victim(Key, Id, Tries))
    ->  (   Q == any
        ->  cluster_running([P|_])
        ;   P = Q
        ),
        ask(P, agent_dispose(Id), dispose(Key, Id, Tries))
    ;   true
    ).
work_event(settlers(P)) :-
    forall(between(1, 3, _), set_out(P, traveller, traveller, [])).
work_event(order(P, X)) :-
    some([sleeper], X, _, Id),
    all_hosts(Hosts),
    length(Hosts, Count),
    I is truncate(X*Count*1000) mod Count,
    nth0(I, Hosts, Host),
    ask(P, agent_move(Id, Host), order).
work_event(look(P, X)) :-
    stays(Kinds),
    some(Kinds, X, _, Id),
    ask(P, agent_property(Id, host(_)), look(Id)).
work_event(tell(P, X)) :-
    stays(Kinds),
    some(Kinds, X, Key, Id),
    write_to(P, Key, Id).

%   Kinds of agents that do not end.

stays([traveller,rover,sitter,heavy,cloner,sleeper]).

some(Kinds, X, Key, Id) :-
    findall(Key0-Id0,
            ( agent(Key0, Kind, Id0, _, _), memberchk(Kind, Kinds) ),
            Agents),
    length(Agents, Count),
    I is min(Count-1, truncate(X*Count)),
    nth0(I, Agents, Key-Id).

write_to(P, Key, Id) :-
    cluster_lives(Lives),
    (   member(life(P, Number, _, inf), Lives)
    ->  atomic_list_concat([P, '.', Number], Sender),
        (   retract(posted(Sender, Key, K0))
        ->  true
        ;   K0 = 0
        ),
        K is K0+1,
        assertz(posted(Sender, Key, K)),
        get_time(Now),
        ask(P, agent_send(Id, m(Sender, K)), tell(Sender, Key, K, Now))
    ;   true
    ).

%   Calls to dead processes do not count.

ask(Name, Goal, What) :-
    call_seconds(Seconds),
    (   cluster_ask(Name, Goal, Seconds, Tag)
    ->  assertz(doing(Tag, What))
    ;   true
    ).

                /*******************************
                *            ANSWERS           *
                *******************************/

%!  work_answers is det.
%
%   Process the answers.

work_answers :-
    cluster_answers(Answers),
    forall(member(answer(Tag, Name, Goal, Result), Answers),
           ( (   retract(doing(Tag, What))
             ->  true
             ;   What = Goal
             ),
             ignore(answered(Result, What, Name)),
             note_call(What, Name, Result)
           )).

answered(yes(agent_create(_, Id, _)), create(Key, Kind), Name) :-
    life(Name, Life),
    get_time(Now),
    assertz(agent(Key, Kind, Id, Life, Now)),
    created(Kind, Key, Id, Name).
answered(Result, dispose(Key, Id, Tries), Name) :-
    (   disposed_of(Result, Tries)
    ->  ask(Name, agent_join(Id, _, 10), join(disposed, Key))
    ;   Tries1 is Tries+1,
        assertz(victim(Key, Id, Tries1))
    ).
answered(yes(agent_join(_, disposed, _)), join(_, Key), _) :-
    get_time(Now),
    assertz(disposed(Key, Now)).
answered(yes(_), tell(Sender, Key, K, Asked), _) :-
    assertz(sent(Sender, Key, K, Asked)).

%   An order without an answer may have been carried out.

disposed_of(yes(_), _).
disposed_of(raised(existence_error(agent, _)), Tries) :-
    Tries > 0.

created(victim, Key, Id, _) :-
    assertz(victim(Key, Id, 0)).
created(sprinter, Key, Id, Name) :-
    cluster_running(Names),
    append(_, [Name|After], Names),
    (   After = [Other|_]
    ->  true
    ;   Names = [Other|_]
    ),
    ask(Other, agent_join(Id, _, 10), join(done, Key)).

life(Name, Name-Number) :-
    cluster_lives(Lives),
    member(life(Name, Number, _, inf), Lives),
    !.

note_call(join(Wanted, Key), Name, yes(agent_join(_, Outcome, _))) :-
    !,
    (   memberchk(Outcome, [Wanted,timeout])
    ->  true
    ;   assertz(failure(join(Wanted, Key), Name, outcome(Outcome)))
    ).
note_call(_, _, yes(_)) :-
    !.
note_call(dispose(_, _, Tries), _, Result) :-
    disposed_of(Result, Tries),
    !.
note_call(What, Name, Result) :-
    assertz(failure(What, Name, Result)).

                /*******************************
                *              END             *
                *******************************/

%!  work_halt is det.
%!  work_roll_call is det.
%
%   Order the agents to stop; let each process send each agent one more
%   message.

work_halt :-
    await_all,
    cluster_running(Names),
    forall(member(Name, Names), ask(Name, on_all_hosts(leave(halt)), halt)),
    await_all.

work_roll_call :-
    cluster_running(Names),
    stays(Kinds),
    forall(( member(Name, Names),
             agent(Key, Kind, Id, _, _),
             memberchk(Kind, Kinds) ),
           write_to(Name, Key, Id)),
    await_all.

await_all :-
    repeat,
    work_answers,
    (   doing(_, _)
    ->  get_time(Now),
        Soon is Now+0.1,
        cluster_wait(Soon),
        fail
    ;   !
    ).

%!  work_agents(-Agents) is det.
%!  work_mail(-Mail) is det.
%!  work_disposed(-Pairs) is det.
%!  work_calls(-Calls) is det.
%
%   agent(Key, Kind, Id, Life, Time) of all that were created, Life being
%   Name-Number of the process that is its home; Key-Time of those that were
%   to be disposed of; sent(Sender, Key, Number, Time) for what
%   the processes wrote to the agents; call(What, Name, Result) for each call
%   that did not succeed.

work_agents(Agents) :-
    findall(agent(Key, Kind, Id, Life, Time),
            agent(Key, Kind, Id, Life, Time), Agents).

work_mail(Mail) :-
    findall(sent(Sender, Key, K, Time), sent(Sender, Key, K, Time), Mail).

work_disposed(Pairs) :-
    findall(Key-Time, disposed(Key, Time), Pairs).

work_calls(Calls) :-
    findall(call(What, Name, Result), failure(What, Name, Result), Calls).
