% Expects: lib; resources, telling; shareable/1, bag/1, solution/1; queue/0,
%   unqueue/0, provided/1; better/2 of a payload.
% Gives: visit/2, deadline/2, await/3, answer_until/1.

/*  How learning agents share: in the queue of a host, and by messages
    (thesis section 4.2.2).  An agent has solution/1 once it has reached the
    goal.

        share(Host)         asks for the units of an agent that is at Host
        shared(units(Units, solution(Actions) or none)), shared(nothing)
                            the answer

    An agent asks only the agents that joined the queue before it.
*/

%   visit(+Wanted, -Gain): the agent joins the end of the queue, asks the
%   others in it one after the other until one of them has something new, and
%   answers requests while it stays.  Wanted is `anything`, or `better`, which
%   accepts only agents with a better solution.  Gain is gain(Before, After),
%   the weights of the bag, or `none`.  New units are put into the bag at
%   once, so that the goals of a waiting agent stay small.

visit(_, none) :-
    parameter(sharing, false),
    !,
    parameter(stay, Seconds),
    sleep(Seconds).
visit(Wanted, Gain) :-
    parameter(stay, Seconds),
    deadline(Seconds, Until),
    findall(Other, sense(queued(Other)), Others),
    queue,
    ask(Others, Wanted, Gain),
    answer_until(Until),
    unqueue.

ask([], _, none).
ask([Other|Others], Wanted, Gain) :-
    (   asked(Other, Units, Solution),
        wanted(Wanted, Solution),
        new(Units, New)
    ->  collected(New, Gain),
        length(New, Size),
        log(shared(Other, Size))
    ;   ask(Others, Wanted, Gain)
    ).

%   An agent that does not answer has left, even if it is still in the queue.

asked(Other, Units, Solution) :-
    here(Here),
    parameter(answer, Seconds),
    (   told(Other, share(Here)),
        await(Other, shared(What), Seconds)
    ->  What = units(Units, Solution)
    ;   ignore(take(queued(Other))),
        fail
    ).

%   While the learning algorithm is exchanged, no solution counts as better.

wanted(anything, _).
wanted(better, solution(Others)) :-
    provided(better/2),
    solution(Actions),
    better(Others, Actions).

new(Units, New) :-
    shareable(Own),
    bag(Bag),
    ord_subtract(Units, Own, New0),
    ord_subtract(New0, Bag, New),
    New \== [].

collected(New, gain(Before, After)) :-
    bag(Old),
    ord_union(Old, New, Bag),
    keep(bag(Bag)),
    bag_weight(Old, Before),
    bag_weight(Bag, After).

                /*******************************
                *            MESSAGES          *
                *******************************/

deadline(Seconds, Until) :-
    now(Now),
    Until is Now + Seconds.

%   await(+Agent, ?Reply, +Seconds): fails at the deadline.  Answers requests
%   of other agents meanwhile.

await(Agent, Reply, Seconds) :-
    deadline(Seconds, Until),
    await_until(Agent, Reply, Until).

await_until(Agent, Reply, Until) :-
    heard(From, What, Until),
    (   From == Agent,
        What = Reply
    ->  true
    ;   respond(What, From),
        await_until(Agent, Reply, Until)
    ).

answer_until(Until) :-
    (   heard(From, What, Until)
    ->  respond(What, From),
        answer_until(Until)
    ;   true
    ).

heard(From, What, Until) :-
    now(Now),
    Seconds is Until - Now,
    Seconds > 0,
    receive(From-What, Seconds).

%   An agent shares nothing with an agent at another host.

respond(share(Here), Agent) :-
    here(Here),
    !,
    shareable(Units),
    (   solution(Actions)
    ->  Solution = solution(Actions)
    ;   Solution = none
    ),
    ignore(told(Agent, shared(units(Units, Solution)))).
respond(share(_), Agent) :-
    !,
    ignore(told(Agent, shared(nothing))).
respond(_, _).
