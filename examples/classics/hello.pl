% hello.pl: says hello on every host nearby

:- agent(hello, []).

main :-
    neighbours(Hosts),
    greet(Hosts).

greet([]).
greet([Host|Hosts]) :-
    move(Host),                         % the rest happens there
    here(Here),
    log(hello_from(Here)),
    greet(Hosts).
