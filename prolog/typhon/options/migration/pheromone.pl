:- module(typhon_pheromone,
          [ emit_here/2,                % +Problem, +Options
            withdraw_here/1,            % +Problem
            pheromone_here/3            % ?Problem, -Source, -Strength
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(apply), [convlist/3, maplist/2]).
:- use_module(library(error), [is_of_type/2, must_be/2, resource_error/1]).
:- use_module(library(lists), [member/2, same_length/2, subtract/3]).
:- use_module(library(option), [option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/compiling', [topics/1]).
:- use_module('../../kernel/base/error_text', [is_tree/2, print_error/2]).
:- use_module('../../kernel/base/prng', [chance_member/4]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_post/3, mobile_term/1]).
:- use_module('../../kernel/host',
              [ address_parts/3, context_host/1, context_now/2, host/3,
                host_neighbours/2, host_time/2, parts_call/3, scheduler_call/1,
                tuple_leave/3, tuple_sense/2, tuple_take/2 ]).
:- use_module(strategy, [memory_chance/4]).

/** <module> Pheromones, and the agents that follow them

A host that needs service emits a pheromone for its problem.  It spreads over
the links as they are then, becomes weaker at every hop, and ends after Span
hops. An agent that can solve the problem follows it to its source by the
migration strategy phercon(Problem): on a host with pheromones whose problem
Problem subsumes, the agent goes to the neighbour from which the strongest came.
On other hosts it behaves as a conscientious agent.  (PherCon: Godfrey and
Nair.)

On a host a pheromone is the tuple

    pheromone(Problem, Source, Strength, Next, Until)

Source is the host that emitted it, Next the neighbour from which it came, Until
the host time at which it has evaporated.  Of two with the same problem and
source the stronger is kept, and of two that are equally strong the newer.

A host has a bounded number of pheromones, of a bounded size, and at most half
of that number from one neighbour, so a flood leaves space for others.  What
does not fit is dropped, and spreads no further.

*Threading*: any thread.  A worker stores and forwards arriving pheromones.
*/

:- topics([pheromone]).

:- multifile
    typhon_options:declared/4,
    typhon_endpoint:received/3,
    typhon_host_parts:ends/1,
    typhon_strategy:choose/6,
    typhon_strategy:strategy/1,
    typhon_place:counted/2.

:- setting(pheromones, positive_integer, 1000,
           "Pheromones that a host has at most").
:- setting(cells, positive_integer, 1000,
           "Cells of the problem of a pheromone, at most; eight characters of \c
            a text count as one").

:- dynamic here/3.              % Host, Next, Count: in its tuple space

                /*******************************
                *           DIFFUSION          *
                *******************************/

%   pheromone_strength(+Maximum, +Span, +Distance, -Strength)
%   pheromone_until(+Emitted, +Period, +Span, +Distance, -Until)
%
%   The strength of a pheromone at Distance hops from its source, and the time
%   at which it evaporates there.  The strength is 0 beyond Span hops.  Near the
%   source it lasts for Span periods, and one period less at each hop.

pheromone_strength(Maximum, Span, Distance, Strength) :-
    Strength is max(0, Maximum - (Distance - 1) * Maximum / Span).

pheromone_until(Emitted, Period, Span, Distance, Until) :-
    Until is Emitted + max(0, Span - Distance + 1) * Period.

%!  emit_here(+Problem, +Options) is det.
%
%   As emit/2 of the vocabulary.

emit_here(Problem, Options) :-
    context_host(Host),
    context_now(Host, Agent),
    parts_call(acts, Host, [Agent, emit(Problem-Options)]),
    must_be(ground, Problem),
    mobile_term(Problem),
    ( is_small(Problem) -> true ; resource_error(pheromone) ),
    check_options(pheromone_option, Options),
    option(span(Span), Options, 3),
    option(strength(Maximum), Options, 100),
    option(period(Period), Options, 10),
    host(Host, Source, Place),
    host_time(Host, Now),
    spread(Host-Place, Source,
           signal(Problem, Source, Maximum, Span, Period, Now, 1)).

is_small(Problem) :-
    setting(cells, Most),
    is_tree(Problem, Most).

typhon_options:declared(pheromone_option, span(Hops), positive_integer, Hops).
typhon_options:declared(pheromone_option, strength(Number), number, Number).
typhon_options:declared(pheromone_option, period(Seconds), number, Seconds).

%   A signal is signal(Problem, Source, Maximum, Span, Period, Emitted,
%   Distance); Distance is that of the hosts that receive it.

spread(Host-Place, From, Signal) :-
    arg(2, Signal, Source),
    host(Host, Here, Place),
    host_neighbours(Host, Neighbours),
    subtract(Neighbours, [From,Source], Hosts),
    inform(Hosts, smelt(Here, Signal)).

%   One worker informs all hosts of this process, one after the other: waking a
%   worker takes longer than its work at a host.

inform(Hosts, News) :-
    convlist(host_here, Hosts, Here),
    (   Here == []
    ->  true
    ;   scheduler_call(typhon_pheromone:news(Here, News))
    ),
    (   same_length(Here, Hosts)        % usually
    ->  true
    ;   endpoint_address(Own),
        forall(( member(Host, Hosts), address_parts(Host, Name, Endpoint),
                 Endpoint \== Own ),
               post(Endpoint, Name, News))
    ).

host_here(Address, Name-Place) :-
    host(Name, Address, Place).

post(Endpoint, Name, News) :-
    catch(endpoint_post(Endpoint, pheromone, pheromone(Name, News)),
          error(Formal, _),
          debug(typhon(pheromone), 'not told ~w@~w: ~p',
                [Name, Endpoint, Formal])).

%   A process that sends anything else is not of this version, or is malicious.

typhon_endpoint:received(pheromone, pheromone(Name, News), Peer) :-
    (   is_news(News, Peer)
    ->  forall(host(Name, _, Place),
               scheduler_call(typhon_pheromone:news([Name-Place], News)))
    ;   debug(typhon(pheromone), 'ignored a pheromone of ~w', [Peer])
    ).

is_news(smelt(From, Signal), Peer) :-
    atom(From),
    address_parts(From, _, Peer),
    ground(Signal),
    Signal = signal(Problem, Source, Maximum, Span, Period, Emitted, D),
    atom(Source),
    maplist(number, [Maximum,Period,Emitted]),
    maplist(is_of_type(positive_integer), [Span,D]),
    is_small(Problem).
is_news(withdrawn(Source, Problem), _) :-
    atom(Source),
    ground(Problem).

news(Hosts, News) :-
    forall(member(Host, Hosts),
           catch(news_at(Host, News), error(Formal, Context),
                 print_error(error, error(Formal, Context)))).

%   The host may be stopped before this or meanwhile, and another of its name be
%   started.

news_at(Host-Place, News) :-
    (   \+ host(Host, _, Place)
    ->  true
    ;   handle_news(News, Host, Place)
    ->  true
    ;   \+ host(Host, _, Place)
    ).

handle_news(smelt(From, Signal), Host, Place) :-
    Signal = signal(Problem, Source, Maximum, Span, Period, Emitted, D),
    pheromone_strength(Maximum, Span, D, Strength),
    pheromone_until(Emitted, Period, Span, D, Until),
    host_time(Host, Now),
    Pheromone = pheromone(Problem, Source, Strength, From, Until),
    (   with_mutex(typhon_pheromone, store(Host, Place, Now, Pheromone)),
        D < Span
    ->  D1 is D + 1,
        spread(Host-Place, From,
               signal(Problem, Source, Maximum, Span, Period, Emitted, D1))
    ;   true
    ).
handle_news(withdrawn(Source, Problem), Host, Place) :-
    (   with_mutex(typhon_pheromone, remove(Place, Problem, Source))
    ->  spread_withdrawal(Host-Place, Source, Problem)
    ;   true
    ).

%   store(+Host, +Place, +Now, +Pheromone) is semidet: fails if Place has a
%   better pheromone, or no space, or Host has ended: the next host of its name
%   would count the pheromone.

store(Host, Place, Now, Pheromone) :-
    once(host(Host, _, Place)),
    Pheromone = pheromone(Problem, Source, Strength, Next, Until),
    Until > Now,
    \+ ( tuple_sense(Place, pheromone(Problem, Source, S0, _, U0)),
         U0 > Now,
         better(S0, U0, Strength, Until) ),
    ignore(remove(Place, Problem, Source)),
    has_space(Host, Place, Now, Next),
    tuple_leave(Place, Pheromone, pheromone(Host, Next)).

%   The tuples are counted, since agents can take them, and leave others like
%   them.

typhon_place:counted(pheromone(Host, Next), Change) :-
    with_mutex(typhon_pheromone, count(Host, Next, Change)).

count(Host, Next, Change) :-
    ( retract(here(Host, Next, Count0)) -> true ; Count0 = 0 ),
    Count is Count0+Change,
    ( Count > 0 -> assertz(here(Host, Next, Count)) ; true ).

typhon_host_parts:ends(Host) :-
    with_mutex(typhon_pheromone, retractall(here(Host, _, _))).

has_space(Host, Place, Now, Next) :-
    (   has_space(Host, Next)
    ->  true
    ;   forall(( tuple_sense(Place, pheromone(Problem, Source, _, _, Until)),
                 number(Until), Until =< Now ),
               ignore(remove(Place, Problem, Source))),
        has_space(Host, Next)
    ).

has_space(Host, Next) :-
    setting(pheromones, Most),
    aggregate_all(sum(Count), here(Host, _, Count), Sum),
    Sum < Most,
    ( here(Host, Next, Count) -> 2*Count < Most ; true ).

better(S0, _, S, _) :-
    S0 > S.
better(S0, U0, S, U) :-
    S0 =:= S,
    U0 >= U.

remove(Place, Problem, Source) :-
    tuple_take(Place, pheromone(Problem, Source, _, _, _)).

%!  withdraw_here(+Problem) is det.
%
%   As withdraw/1 of the vocabulary.

withdraw_here(Problem) :-
    context_host(Host),
    context_now(Host, Agent),
    parts_call(acts, Host, [Agent, emit(Problem)]),
    must_be(ground, Problem),
    host(Host, Source, Place),
    spread_withdrawal(Host-Place, Source, Problem).

spread_withdrawal(Host-Place, Source, Problem) :-
    host(Host, _, Place),
    host_neighbours(Host, Neighbours),
    subtract(Neighbours, [Source], Hosts),
    inform(Hosts, withdrawn(Source, Problem)).

%!  pheromone_here(?Problem, -Source, -Strength) is nondet.
%
%   As pheromone/3 of the vocabulary.

pheromone_here(Problem, Source, Strength) :-
    context_host(Host),
    live(Host, Problem, Source, Strength, _).

live(Host, Problem, Source, Strength, Next) :-
    host(Host, _, Place),
    host_time(Host, Now),
    tuple_sense(Place, pheromone(Problem, Source, Strength, Next, Until)),
    Until > Now.

%   Only a pheromone that came from a present neighbour can be followed.  Among
%   equally strong ones the agent chooses at random.

typhon_strategy:strategy(phercon(_)).

typhon_strategy:choose(phercon(Problem), Hosts, Here, Memory0, Host, Memory) :-
    findall(Strength-Next, followable(Here, Problem, Hosts, Strength, Next),
            Trails),
    aggregate_all(max(Strength), member(Strength-_, Trails), Most),
    !,
    findall(Next, member(Most-Next, Trails), Nexts0),
    sort(Nexts0, Nexts),
    memory_chance(Memory0, Chance0, Chance, Memory),
    chance_member(Host, Nexts, Chance0, Chance).
typhon_strategy:choose(phercon(_), Hosts, Here, Memory0, Host, Memory) :-
    typhon_strategy:choose(conscientious, Hosts, Here, Memory0, Host, Memory).

followable(Here, Problem, Hosts, Strength, Next) :-
    host(Name, Here, _),
    live(Name, Found, _, Strength, Next),
    subsumes_term(Problem, Found),
    memberchk(Next, Hosts).
