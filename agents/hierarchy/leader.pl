:- agent(leader, [state([setting/2, decides/1, limit/1, memory/1])]).
:- use_module(library(typhon)).
:- include('../lib/keep').
:- include(orders).

/*  Leads the workers of one part of a network: the middle level of a hierarchy
    (thesis section 8.2).  For each round of work it creates workers, waits
    until they have ended, reads the facts that they have left on the hosts,
    and changes their parameters before the next round.

        serve(Round, Hosts)     request of a customer; the answer is
                                served(Round)

    A payload, the mechanism, defines the workers, the observations of a
    leader on a host, and the changes of parameters.  It provides

        crew(+Round, +Hosts, +Settings, -Orders)
                                the workers, each order(Program, Options), for
                                create/3
        seen(+Round, -Facts)    the observations on this host
        decided(+Reports, +Memory0, -Memory, -Orders)
                                Reports are pairs of a leader and
                                report(Settings, Ends, Facts).  Settings are
                                its pairs Name-Value; Ends has
                                ended(Seconds, Outcome) for each worker,
                                Outcome is `late` if it was disposed of; Facts
                                are the results of seen/2.  Orders are pairs
                                of a leader and its changed settings.  Memory,
                                at first `none`, keeps what the mechanism has
                                learnt

    Facts: setting(Name, Value), of workers and of the mechanism;
    limit(Seconds), after which workers are disposed of.  The fact
    decides(Agent) names the agent that decides: `self`, `none`, or an
    observer, which has the same payload and the reports of all leaders.
*/

default(workers, 1, range(1, 20, 1), "workers in each part").

main :-
    receive(Customer-serve(Round, Hosts)),
    Hosts = [First|_],
    visit(First),
    settings(Settings),
    begin(Round, Hosts, Settings, Workers),
    now(Start),
    attend(Workers, Start, Ends),
    tour(Hosts, Round, [], Facts),
    decide(Round, report(Settings, Ends, Facts)),
    send(Customer, served(Round)),
    main.

settings(Settings) :-
    findall(Name-Value, ( setting(Name, Value)
                        ; default(Name, Value, _, _),
                          \+ setting(Name, _) ),
            Settings).

begin(Round, Hosts, Settings, Workers) :-
    log(leads(Round, Settings)),
    crew(Round, Hosts, Settings, Orders),
    findall(Worker,
            ( member(order(Program, Options), Orders),
              create(Program, Worker, Options) ),
            Workers),
    forall(member(Worker, Workers), monitor(Worker)),
    forall(member(Worker, Workers), send(Worker, begin)).

attend([], _, []).
attend([Worker|Workers], Start, [ended(Seconds, Outcome)|Ends]) :-
    limit(Limit),
    now(Now),
    Left is max(0, Start + Limit - Now),
    (   receive(system-down(Worker, Outcome0), Left)
    ->  Outcome = Outcome0
    ;   Outcome = late,
        catch(agent_dispose(Worker), error(_, _), true)
    ),
    now(End),
    Seconds is End - Start,
    attend(Workers, Start, Ends).

%   Skips hosts that have ended meanwhile.

tour([], _, Facts, Facts).
tour([Host|Hosts], Round, Facts0, Facts) :-
    (   visit(Host)
    ->  seen(Round, Here),
        append(Here, Facts0, Facts1)
    ;   Facts1 = Facts0
    ),
    tour(Hosts, Round, Facts1, Facts).

visit(Host) :-
    catch(move(Host), error(_, _), fail).

                /*******************************
                *           DECISIONS          *
                *******************************/

decide(Round, Report) :-
    decides(Decider),
    decide(Decider, Round, Report).

decide(none, _, _) :-
    !.
decide(self, _, Report) :-
    !,
    self(Me),
    orders([Me-Report], [_-Changes]),
    obey(Changes).
decide(Observer, Round, Report) :-
    send(Observer, report(Round, Report)),
    receive(Observer-change(Round, Changes)),
    obey(Changes).

obey(Changes) :-
    forall(member(Name-Value, Changes),
           ( retractall(setting(Name, _)),
             assertz(setting(Name, Value)) )).
