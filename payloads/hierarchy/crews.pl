:- payload(crews, [provides([crew/4, seen/2, decided/4])]).

/*  Leaders of agents that learn and share (agents/hierarchy/leader.pl):
    workers are agents(learning/learner), and the mechanism learns how much
    work a part has.

    The time of agents that share is nearly inversely proportional to their
    number.  So the work of a part is the time of its last worker times the
    number of its workers.  The mechanism divides the workers in proportion to
    the work of the previous round; each part keeps at least half of an equal
    share, and one worker.  A leader that decides for itself can only keep its
    own workers.
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

%   A worker that was disposed of may have left its tuple in the queue.

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
%   not taken.

divided([], _, _, _, []).
divided([part(Leader, Work, _)|Parts], Least, All, Workers,
        [Leader-[workers-Count]|Orders]) :-
    length(Parts, Others),
    Share is round(Workers*Work/max(0.001, All)),
    Count is max(Least, min(Workers - Least*Others, Share)),
    Left is Workers - Count,
    Rest is All - Work,
    divided(Parts, Least, Rest, Left, Orders).
