% dictionary.pl: a librarian; the word determines the host that stores it

:- agent(dictionary, [state([shelves/1])]).

main :-
    neighbours(Hosts),
    assertz(shelves(Hosts)).

on_message(_, define(Word, Meaning)) :-
    shelf(Word, Host),
    move(Host),
    ignore(take(entry(Word, _))),
    leave(entry(Word, Meaning)).
on_message(From, look_up(Word)) :-
    shelf(Word, Host),
    move(Host),
    (   sense(entry(Word, Meaning))
    ->  send(From, means(Word, Meaning))
    ;   send(From, unknown(Word))
    ).

shelf(Word, Host) :-
    shelves(Hosts),
    length(Hosts, Count),
    sub_atom(Word, 0, 1, _, Letter),
    char_code(Letter, Code),
    N is Code mod Count,
    nth0(N, Hosts, Host).
