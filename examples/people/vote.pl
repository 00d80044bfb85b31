% vote.pl: each person of the class chooses, and sees the result

:- agent(vote, [state([question/1, choices/1])]).

main :-
    neighbours(Hosts),
    ballot(Hosts, Votes),
    result_of(Votes, Result),
    announce(Hosts, Result),
    result(Result).

ballot([], []).
ballot([Host|Hosts], [Vote|Votes]) :-
    move(Host),
    question(Question),
    choices(Choices),
    choose(Question, Choices, Vote),
    ballot(Hosts, Votes).

result_of(Votes, Result) :-
    msort(Votes, Sorted),
    clumped(Sorted, Counts),
    sort(2, @>=, Counts, Result).       % most votes first

announce([], _).
announce([Host|Hosts], Result) :-
    move(Host),
    show(Result),
    announce(Hosts, Result).
