% flood.pl: brings news to every host, once

:- agent(flood, [state([news/1])]).

main :-
    flood(0).

flood(Hops) :-
    news(News),
    (   leave_new(news(News))
    ->  leave(hops(News, Hops)),
        neighbours(Hosts),
        Next is Hops+1,
        spread(Hosts, Next)
    ;   true                            % this host already has the news
    ).

spread([], _).
spread([Host|Hosts], Hops) :-
    clone(Host, Who),
    (   Who = clone(_)
    ->  flood(Hops)
    ;   spread(Hosts, Hops)
    ).
