:- module(typhon_alarm_index,
          [ index_make/1,               % -Index
            index_insert/3,             % +Index0, +Stamp, -Index
            index_delete/3,             % +Index0, +Stamp, -Index
            index_first/2,              % +Index, -Stamp
            index_size/2                % +Index, -Count
          ]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(library(rbtrees),
              [ ord_list_to_rbtree/2, rb_delete/3, rb_insert/4, rb_min/3,
                rb_size/2 ]).
:- use_module(alarms,
              [ alarm_least/1, alarm_stamps/1, alarms_number/1, alarms_thin/0
              ]).

/** <module> Which alarm comes first

An index holds all the stamps that alarms are set to, and some more, and is
made anew when Left more have been set; then the alarms that are over are
forgotten.  It is index(Stamps, Left), a tree, or least(Stamp, Left), only
the first, where a tree would fill the stack.  Then the next is looked for
when that has gone off.

*Threading*: an index is on the stack of the timer.
*/

:- multifile prolog:message//1.

%!  index_make(-Index) is det.

index_make(Index) :-
    alarms_thin,
    alarms_number(Count),
    More is max(500, Count),
    current_prolog_flag(stack_limit, Bytes),
    Space is Bytes//512-Count,
    (   Space > 0
    ->  tree(Stamps),
        Left is min(Space, More),
        Index = index(Stamps, Left)
    ;   print_message(warning, typhon(no_index(Count))),
        alarm_least(Stamp),
        Index = least(Stamp, More)
    ).

tree(Stamps) :-
    alarm_stamps(Set),
    pairs_keys_values(Pairs, Set, Set),
    ord_list_to_rbtree(Pairs, Stamps).

%!  index_insert(+Index0, +Stamp, -Index) is det.
%!  index_delete(+Index0, +Stamp, -Index) is det.

index_insert(least(_, 0), _, Index) :-
    !,
    index_make(Index).
index_insert(least(Stamp0, Left0), Stamp1, least(Stamp, Left)) :-
    Left is Left0-1,
    Stamp is min(Stamp0, Stamp1).
index_insert(index(_, 0), _, Index) :-
    !,
    index_make(Index).
index_insert(index(Stamps0, Left0), Stamp, index(Stamps, Left)) :-
    Left is Left0-1,
    rb_insert(Stamps0, Stamp, Stamp, Stamps).

index_delete(least(_, Left), _, least(Stamp, Left)) :-
    alarm_least(Stamp).
index_delete(index(Stamps0, Left), Stamp, index(Stamps, Left)) :-
    (   rb_delete(Stamps0, Stamp, Stamps)
    ->  true
    ;   Stamps = Stamps0
    ).

%!  index_first(+Index, -Stamp) is det.
%
%   `inf` if there is none.

index_first(least(Stamp, _), Stamp).
index_first(index(Stamps, _), Stamp) :-
    (   rb_min(Stamps, First, _)
    ->  Stamp = First
    ;   Stamp = inf
    ).

%!  index_size(+Index, -Count) is det.

index_size(least(_, _), 1).
index_size(index(Stamps, _), Size) :-
    rb_size(Stamps, Size).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(no_index(Count))) -->
    [ 'The timer has no memory for an index of ~D alarms, and is slow'-
      [Count] ].
