:- payload(crews, [provides([crew/4, seen/2, decided/4])]).

/*  Leaders of agents that learn and share (agents/hierarchy/leader.pl):
    workers are agents(learning/learner), and the mechanism learns how much
    work a part has.

    Agents that share take the less time, the more they are: nearly in proportion.
    So the work of a part is the time of its last worker times their number, and workers
    are divided among the parts as work was in the last round, each with one at least.
    A leader that decides by itself can only keep those it has.
*/

crew(_, Hosts, Settings, Orders) :-
    memberchk(workers-Count, Settings),
    memberchk(algorithm-Algorithm, Settings),
    findall(setting(Name, Value), member(Name-Value, Settings), Facts),
    length(Hosts, Length),
    findall(order(agents(learning/learner),
                  [ host(Host), payloads([payloads(learning/Algorithm)]),
                    facts([setting(start, order)|Facts]) ]),
            ( between(1, Count, I),
              Index is (I - 1)*Length // Count mod Length,
              nth0(Index, Hosts, Host) ),
            Orders).

%   A worker that was late may be in a queue still.

seen(Round, Facts) :-
    take(queued(_)),
    !,
    seen(Round, Facts).
seen(_, []).

decided(Reports, Memory, Memory, Orders) :-
    findall(part(Leader, Work, Count),
            ( member(Leader-report(Settings, Ends, _), Reports),
              memberchk(workers-Count, Settings),
              findall(Seconds, member(ended(Seconds, _), Ends), Times),
              max_list(Times, Last),
              Work is Last*Count ),
            Parts),
    findall(Work, member(part(_, Work, _), Parts), Works),
    findall(Own, member(part(_, _, Own), Parts), Owns),
    sum_list(Works, All),
    sum_list(Owns, Workers),
    length(Parts, Count),
    Least is max(1, Workers // (2*Count)),
    divided(Parts, Least, All, Workers, Orders).

%   Each part gets its share of the workers that the parts before it have
%   left.

divided([], _, _, _, []).
divided([part(Leader, Work, _)|Parts], Least, All, Workers,
        [Leader-[workers-Count]|Orders]) :-
    length(Parts, Others),
    Share is round(Workers*Work/max(0.001, All)),
    Count is max(Least, min(Workers - Least*Others, Share)),
    Left is Workers - Count,
    Rest is All - Work,
    divided(Parts, Least, Rest, Left, Orders).
