% flood.pl: brings news to every host, once

:- agent(flood, [state([news/1])]).

main :-
    flood(0).

flood(Hops) :-
    news(News),
    (   sense(news(News, _))
    ->  true                            % somebody was here before
    ;   leave(news(News, Hops)),
        neighbours(Hosts),
        Next is Hops+1,
        spread(Hosts, Next)
    ).

spread([], _).
spread([Host|Hosts], Hops) :-
    clone(Host, Who),
    (   Who = clone(_)
    ->  flood(Hops)
    ;   spread(Hosts, Hops)
    ).
