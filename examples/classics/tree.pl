% tree.pl: a search tree whose nodes are hosts

:- agent(tree, []).

on_message(_, insert(Key)) :-
    home(Root),
    move(Root),
    insert(Key, none).
on_message(From, member(Key)) :-
    home(Root),
    move(Root),
    (   member_of(Key, none)
    ->  here(Host),
        send(From, found(Key, Host))
    ;   send(From, no(Key))
    ).
on_message(From, keys) :-
    home(Root),
    move(Root),
    keys(none, Keys),
    send(From, keys(Keys)).

insert(Key, From) :-
    (   sense(key(Here))
    ->  descend(Key, Here, From, Parent),
        insert(Key, Parent)
    ;   leave(key(Key))
    ).

member_of(Key, From) :-
    sense(key(Here)),
    (   Key == Here
    ->  true
    ;   descend(Key, Here, From, Parent),
        member_of(Key, Parent)
    ).

descend(Key, Here, From, Parent) :-
    here(Parent),
    children(From, Left, Right),
    (   Key @< Here
    ->  move(Left)
    ;   move(Right)
    ).

%   Keys of the left subtree come first, then the key of this host.

keys(From, Keys) :-
    (   sense(key(Key))
    ->  here(Parent),
        (   children(From, Left, Right)
        ->  move(Left),
            keys(Parent, Smaller),
            move(Right),
            keys(Parent, Larger),
            append(Smaller, [Key|Larger], Keys)
        ;   Keys = [Key]
        )
    ;   Keys = []
    ).

children(From, Left, Right) :-
    neighbours(Hosts),
    subtract(Hosts, [From], [Left, Right]).
