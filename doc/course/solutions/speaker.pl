% speaker.pl: people elect a speaker, in two ballots if one does not decide

:- agent(speaker, [state([candidates/1])]).

main :-
    candidates(Names),
    neighbours(Hosts),
    elected(Hosts, Names, Speaker),
    announce(Hosts, Speaker),
    result(Speaker).

elected(Hosts, Names, Speaker) :-
    ballot(Hosts, Names, Votes),
    counted(Votes, [First-Most|Others]),
    length(Votes, Count),
    (   2*Most > Count
    ->  Speaker = First
    ;   Others = [Second-_|_],
        ballot(Hosts, [First,Second], Again),
        counted(Again, [Speaker-_|_])
    ).

ballot([], _, []).
ballot([Host|Hosts], Names, [Vote|Votes]) :-
    move(Host),
    choose("Who shall speak for us?", Names, Vote),
    ballot(Hosts, Names, Votes).

counted(Votes, Counts) :-
    msort(Votes, Sorted),
    clumped(Sorted, Counts0),
    sort(2, @>=, Counts0, Counts).      % keeps the order of equals

announce([], _).
announce([Host|Hosts], Speaker) :-
    move(Host),
    show(speaker(Speaker)),
    announce(Hosts, Speaker).
