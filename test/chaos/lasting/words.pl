:- module(lasting_words,
          [ words/2                     % +Options, -Report
          ]).

/** <module> Numbered words, between agents whose processes are killed

Who talks says numbered words to another, who says each back; some travel
meanwhile, so words come in any order, but each once.  All is over when each has said all its words, and has heard all of
them back and all of who talks to it; if that does not come the processes say
what they have in hand.

*Threading*: the main thread.
*/

:- use_module(nodes).
:- use_module('../../lib/common', [wait_until/2]).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, append/3, member/2, nth0/3]).
:- use_module(library(option), [option/3]).

%   A talker travels if it has a route.  What is wrong it notes, and goes on.

program(clauses([
    (:- agent(talker, [state([todo/1, route/1, said/1, back/1, heard/1,
                              friend/1, early/2, wrong/1])])),
    said(0),
    back(0),
    heard(0),
    (main :-
        receive(_-friend(Friend)),
        assertz(friend(Friend)),
        talk),
    (talk :-
        todo(N), said(N), back(N), heard(N),
        !,
        findall(W, wrong(W), Wrong),
        result(Wrong)),
    (talk :-
        say,
        walk,
        listen(0.01),
        talk),
    (say :- said(N), todo(N), !),
    (say :-
        retract(said(N0)), N is N0+1, assertz(said(N)),
        friend(Friend), self(Me),
        send(Friend, word(Me, N))),
    (walk :-
        said(N), N mod 5 =:= 0,
        route([Host|Hosts]),
        !,
        catch(move(Host), error(_, _), true),
        retract(route(_)),
        !,
        append(Hosts, [Host], Route),
        assertz(route(Route))),
    walk,
    (listen(Seconds) :-
        (   receive(_-What, Seconds)
        ->  take_in(What),
            listen(0)
        ;   true
        )),
    (take_in(word(Who, N)) :- count(heard, N), send(Who, echo(N))),
    (take_in(echo(N)) :- count(back, N)),
    (count(What, N) :-
        Known =.. [What, N0],
        call(Known),
        (   ( N =< N0 ; early(What, N) )
        ->  assertz(wrong(twice(What, N)))
        ;   assertz(early(What, N)),
            catch_up(What)
        )),
    (catch_up(What) :-
        Known =.. [What, N0],
        call(Known),
        N is N0+1,
        (   retract(early(What, N))
        ->  retract(Known),
            Next =.. [What, N],
            assertz(Next),
            catch_up(What)
        ;   true
        )) ])).

%!  words(+Options, -Report) is det.
%
%   Options and Report as of lasting/2.

words(Options, report(Facts, Wrong)) :-
    option(seed(Seed), Options, 1),
    option(agents(Agents), Options, 12),
    option(hops(Each), Options, 300),
    set_random(seed(Seed)),
    get_time(Start),
    setup_call_cleanup(
        host_start(driver),
        with_nodes(Options, Nodes, said(Nodes, Options, Wrong), Told),
        host_stop(driver)),
    get_time(End),
    Seconds is End-Start,
    Hops is Agents*Each,
    Facts = [seconds(Seconds), hops(Hops)|Told].

said(Nodes, Options, Wrong) :-
    option(agents(Agents), Options, 12),
    option(hops(Each), Options, 300),
    option(seconds(Limit), Options, 100),
    maplist(node_host, Nodes, Hosts),
    findall(A, ( between(1, Agents, I), talker(I, Hosts, Each, A) ), Talkers),
    introduced(Talkers),
    get_time(Now),
    Deadline is Now+Limit,
    war(Options),
    findall(_, ( member(A, Talkers), ends(A, Deadline, _) ), _),
    peace,
    Later is Deadline+Limit,            % on a slow machine
    findall(A-End, ( member(A, Talkers), ends(A, Later, End) ), Ends),
    findall(W, wrong(Ends, W), Wrong0),
    (   Wrong0 == []
    ->  Wrong = []
    ;   findall(A-Facts,
                ( member(A-E, Ends), E \== done,
                  catch(agent_property(A, facts(Facts)), error(X, _),
                        Facts = X) ), Left),
        append(Wrong0, Left, Wrong),
        nodes_look,
        sleep(3),
        nodes_said(Nodes, Lines),
        forall(member(Line, Lines), format(user_error, '~w~n', [Line]))
    ).

talker(I, Hosts, Each, Agent) :-
    length(Hosts, Count),
    J is I mod Count,
    nth0(J, Hosts, Host),
    append(Before, [Host|After], Hosts),
    append([After, Before, [Host]], Route),
    (   I mod 3 =:= 0
    ->  Travels = [route(Route)]
    ;   Travels = []
    ),
    program(Program),
    agent_create(Program, Agent,
                 [host(Host), facts([todo(Each)|Travels])]).

introduced(Talkers) :-
    Talkers = [First|Others],
    append(Others, [First], Friends),
    forall(( nth0(I, Talkers, A), nth0(I, Friends, B) ),
           agent_send(A, friend(B))),
    wait_until(\+ ( member(A, Talkers), \+ has_friend(A) ), 60).

%   What the driver sends dies with a process, as it keeps no journal.

has_friend(Agent) :-
    agent_property(Agent, facts(Facts)),
    memberchk(friend(_), Facts).

ends(Agent, Deadline, End) :-
    get_time(Now),
    Left is Deadline-Now,
    (   Left =< 0
    ->  End = late
    ;   Some is min(2, Left),
        catch(agent_join(Agent, End0, Some), error(Formal, _),
              End0 = error(Formal)),
        settled_end(End0, Agent, Deadline, End)
    ).

settled_end(End, Agent, Deadline, End1) :-
    ( End == timeout ; End = error(_) ; End == unknown ),
    !,
    sleep(0.1),
    ends(Agent, Deadline, End1).
settled_end(End, _, _, End).

wrong(Ends, ended(Agent, End)) :-
    member(Agent-End, Ends),
    End \== done.
wrong(Ends, heard(Agent, What)) :-
    member(Agent-done, Ends),
    wait_until(catch(agent_result(Agent, What, 5), error(_, _), fail), 60),
    What \== [].
