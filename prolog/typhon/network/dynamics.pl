:- module(typhon_dynamics,
          [ dynamics_model/2,           % +Spec, -Model
            dynamics_state/5,           % +Model, +N, +Edges, +Seed, -State
            dynamics_event/4,           % +State0, -Time, -Changes, -State
            dynamics_until/3,           % +State0, +Time, -State
            dynamics_edges/2            % +State, -Edges
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc),
              [gen_assoc/3, get_assoc/3, list_to_assoc/2, put_assoc/4]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(heaps), [add_to_heap/4, empty_heap/1, get_from_heap/4]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(ordsets),
              [ord_add_element/3, ord_del_element/3, ord_subtract/3]).
:- use_module('../kernel/base/prng',
              [ chance_below/4, chance_member/4, chance_seed/2, chance_true/4,
                chance_uniform/5 ]).

/** <module> Models of links that change

A model defines how the links of a network change. Each host acts independently.
It acts again and again after an Interval, uniform(Min,Max) in host seconds,
from which each delay is drawn:

  - links(Interval, Drop, Add)
    The host drops one of its links, drawn at random, with probability Drop.
    Then it makes a link to a host to which it has none, drawn at random, with
    probability Add. With each(P) for Drop each of its links is dropped with
    probability P, independently.
  - toggle(Interval, Drop, Add)
    The host draws one of the links that it had at the start of the network.
    If the link exists it is dropped with probability Drop, else it is made
    with probability Add. No other links are made.

Models with a name, after the experiments of the thesis:

| random_links | links(uniform(10,20), 0.3, 0.5)        | section 4.4.7 |
| thesis_4_4_7 | links(uniform(10,20), each(0.3), 0.5)  | section 4.4.7 |
| dynamic_1    | toggle(uniform(10,20), 0.5, 0.7)       | section 5.5   |
| dynamic_2    | links(uniform(10,20), 0.5, 0.7)        | section 5.5   |

Section 4.4.7 begins with a mesh of 50 hosts and reports degrees from 0 to 27.
Dropping one link at a time never leads to such degrees: a mesh stays above
degree 44, as more links are added than dropped. Dropping each link
independently does. Hence the two models. For Dynamic I the thesis prints no
probabilities, and for neither network of chapter 5 intervals; the values of
Dynamic II and of section 4.4.7 are used. The general forms allow other values.

The decisions are pure: a state is a term, and the sequence of events follows
from the seed. Runs differ only by the delay with which a thread applies the
events.

*Threading*: pure; module `changes` applies the events.
*/

                /*******************************
                *            MODELS            *
                *******************************/

%!  dynamics_model(+Spec, -Model) is det.
%
%   Model is the general form of Spec.
%
%   @error domain_error(dynamic_model, Spec)

dynamics_model(Spec, Model) :-
    must_be(nonvar, Spec),
    (   named_model(Spec, Model)
    ->  true
    ;   general_model(Spec)
    ->  Model = Spec
    ;   domain_error(dynamic_model, Spec)
    ).

:- multifile typhon_names:known/2.

typhon_names:known(dynamic_model, Name) :-
    named_model(Name, _).
typhon_names:known(dynamic_model, links('Interval', 'Drop', 'Add')).
typhon_names:known(dynamic_model, toggle('Interval', 'Drop', 'Add')).

named_model(random_links, links(uniform(10, 20), 0.3, 0.5)).
named_model(thesis_4_4_7, links(uniform(10, 20), each(0.3), 0.5)).
named_model(dynamic_1, toggle(uniform(10, 20), 0.5, 0.7)).
named_model(dynamic_2, links(uniform(10, 20), 0.5, 0.7)).

general_model(links(Interval, Drop, Add)) :-
    interval(Interval),
    (   Drop = each(P)
    ->  probability(P)
    ;   probability(Drop)
    ),
    probability(Add).
general_model(toggle(Interval, Drop, Add)) :-
    interval(Interval),
    probability(Drop),
    probability(Add).

interval(uniform(Min, Max)) :-
    number(Min),
    number(Max),
    Min > 0,
    Max >= Min.

probability(P) :-
    number(P),
    P >= 0,
    P =< 1.

                /*******************************
                *          DECISIONS           *
                *******************************/

%!  dynamics_state(+Model, +N, +Edges, +Seed, -State) is det.
%
%   State is the initial state of a network of N hosts with Edges, pairs I-J of
%   host numbers. The time of the first event of each host is drawn.

dynamics_state(Model, N, Edges, Seed,
               state(Model, N, Own, Links, Due, Chance)) :-
    findall(I-J, ( member(A-B, Edges), ends(A, B, I, J) ), Ends0),
    sort(Ends0, Ends),
    numlist(1, N, Hosts),
    findall(Host-Ns,
            ( member(Host, Hosts),
              findall(J, member(Host-J, Ends), Ns) ),
            Pairs),
    list_to_assoc(Pairs, Links),
    own_links(Model, Links, Own),
    chance_seed(Seed, Chance0),
    empty_heap(Due0),
    foldl(schedule(Model, 0), Hosts, Due0-Chance0, Due-Chance).

ends(A, B, A, B).
ends(A, B, B, A).

%   Only some models need the initial links: without them the state, which is
%   copied for each event, is smaller.

own_links(toggle(_, _, _), Links, Links).
own_links(links(_, _, _), _, none).

schedule(Model, Now, Host, Due0-Chance0, Due-Chance) :-
    arg(1, Model, uniform(Min, Max)),
    chance_uniform(Min, Max, Wait, Chance0, Chance),
    Time is Now + Wait,
    add_to_heap(Due0, Time, Host, Due).

%!  dynamics_event(+State0, -Time, -Changes, -State) is semidet.
%
%   At Time, in host seconds after the start, the links of one host change:
%   Changes are terms link(I,J) and unlink(I,J), to be applied in this order.
%   State is the state after them. Fails if no link can ever change.

dynamics_event(state(Model, N, Own, Links0, Due0, Chance0), Time, Changes,
               state(Model, N, Own, Links, Due, Chance)) :-
    get_from_heap(Due0, Time, Host, Due1),
    get_assoc(Host, Links0, Ns),
    changes(Model, host(Host, N, Ns, Own), Changes, Chance0, Chance1),
    foldl(change, Changes, Links0, Links),
    schedule(Model, Time, Host, Due1-Chance1, Due-Chance).

%!  dynamics_until(+State0, +Time, -State) is det.
%
%   State is the state after all events of State0 before Time.

dynamics_until(State0, Time, State) :-
    (   dynamics_event(State0, Next, _, State1),
        Next < Time
    ->  dynamics_until(State1, Time, State)
    ;   State = State0
    ).

%!  dynamics_edges(+State, -Edges) is det.
%
%   Edges are the links in State, pairs I-J with I < J.

dynamics_edges(state(_, _, _, Links, _, _), Edges) :-
    findall(I-J,
            ( gen_assoc(I, Links, Ns), member(J, Ns), I < J ),
            Edges).

change(link(I, J), Links0, Links) :-
    change_end(ord_add_element, I, J, Links0, Links1),
    change_end(ord_add_element, J, I, Links1, Links).
change(unlink(I, J), Links0, Links) :-
    change_end(ord_del_element, I, J, Links0, Links1),
    change_end(ord_del_element, J, I, Links1, Links).

change_end(Op, I, J, Links0, Links) :-
    get_assoc(I, Links0, Ns0),
    call(Op, Ns0, J, Ns),
    put_assoc(I, Links0, Ns, Links).

%   changes(+Model, +Host, -Changes, +Chance0, -Chance): Changes are those of
%   the next event of Host, host(I, N, Neighbours, Own).

changes(links(_, Drop, Add), host(I, N, Ns, _), Changes, Chance0, Chance) :-
    dropped(Drop, Ns, Gone, Chance0, Chance1),
    ord_subtract(Ns, Gone, Left),
    added(Add, I, N, Ns, New, Chance1, Chance),
    findall(unlink(I, J), member(J, Gone), Changes, Made),
    findall(link(I, J), ( member(J, New), \+ memberchk(J, Left) ), Made).
changes(toggle(_, Drop, Add), host(I, _, Ns, Own), Changes, Chance0, Chance) :-
    get_assoc(I, Own, OwnNs),
    (   chance_member(J, OwnNs, Chance0, Chance1)
    ->  (   memberchk(J, Ns)
        ->  chance_true(Drop, Bool, Chance1, Chance),
            Change = unlink(I, J)
        ;   chance_true(Add, Bool, Chance1, Chance),
            Change = link(I, J)
        ),
        ( Bool == true -> Changes = [Change] ; Changes = [] )
    ;   Changes = [],
        Chance = Chance0
    ).

dropped(each(P), Ns, Gone, Chance0, Chance) :-
    !,
    foldl(drop_one(P), Ns, Gone-Chance0, []-Chance).
dropped(P, Ns, Gone, Chance0, Chance) :-
    chance_true(P, Bool, Chance0, Chance1),
    (   Bool == true,
        chance_member(J, Ns, Chance1, Chance)
    ->  Gone = [J]
    ;   Gone = [],
        Chance = Chance1
    ).

drop_one(P, J, Gone0-Chance0, Gone-Chance) :-
    chance_true(P, Bool, Chance0, Chance),
    (   Bool == true
    ->  Gone0 = [J|Gone]
    ;   Gone0 = Gone
    ).

%   An event does not make again a link that it has dropped: the host at the
%   other end still counts as a neighbour.

added(P, I, N, Ns, New, Chance0, Chance) :-
    chance_true(P, Bool, Chance0, Chance1),
    (   Bool == true,
        ord_add_element(Ns, I, Taken),
        length(Taken, Count),
        Free is N-Count,
        Free > 0
    ->  chance_below(Free, Index, Chance1, Chance),
        First is Index+1,
        not_taken(Taken, First, J),
        New = [J]
    ;   New = [],
        Chance = Chance1
    ).

%   not_taken(+Taken, +K, -J): J is the K-th number from 1 on that is not in the
%   ordered list Taken.  A list of all such numbers would be as long as the
%   network.

not_taken([Number|Taken], K, J) :-
    Number =< K,
    !,
    K1 is K+1,
    not_taken(Taken, K1, J).
not_taken(_, K, K).
