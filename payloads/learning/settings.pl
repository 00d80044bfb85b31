:- payload(settings, [provides([ start/2, actions/1, act/3, sensed/2,
                                 weight/3, reached/1, shareable/2 ])]).
:- include(printer).

/*  Printers that find the settings for good pictures (thesis section 4.1): a
    problem for agents(learning).  Each printer differs a little.

    A list of settings has a level for each of resolution, mode, paper,
    toner density, heat of the fuser, and speed.  Numbers are levels in
    order, 1 the least; atoms have no order.  An action prints a page:

        set(Place, Level)   with one of the settings changed
        again               with the same settings again
        use(Settings)       with Settings; in plans only

    A sensor vector is sv(Printer, Settings, Quality).  The quality, from 0 to
    about 1, is the quality of this page as the printer itself measures it, with
    noise; the quality without noise cannot be sensed.  So the goal is reached
    when several successive pages, printed with the same settings, have been
    good on average.  Noise may cause this: a printer has no other evidence
    that its settings are good.

    Units are unit(Printer, Settings, Quality), one for each page, good or
    bad, since a learning algorithm can use both.  The weight of a unit that
    was no better than the previous page is 0.

    Facts of the agent with this payload replace the defaults: setting(noise,
    N), the standard deviation of a measurement; setting(good, Q), the quality
    of a good page; setting(pages, N), the number of successive pages;
    setting(difference, D), the greatest deviation of the best density and heat
    of a printer; setting(printers, Seed), the seed of their properties.  Seed
    and the name of the host determine a printer, so it is the same in every
    execution.
*/

levels(1, [1,2,3,4]).                   % resolution
levels(2, [draft,text,photo]).          % mode
levels(3, [thin,plain,thick,glossy]).   % paper
levels(4, [1,2,3,4,5,6,7,8,9]).         % toner density
levels(5, [1,2,3,4,5,6,7,8,9]).         % heat
levels(6, [1,2,3,4,5]).                 % speed

factory([2,text,plain,4,3,3]).

                /*******************************
                *           PRINTING           *
                *******************************/

%   A state is page(Settings, Qualities, Chance): the qualities of the
%   successive pages printed with the same settings, the last one first.

start(Chance, State) :-
    factory(Settings),
    printed(Settings, [], Chance, State).

printed(Settings, Qualities, Chance0, page(Settings, All, Chance)) :-
    printer(Printer),
    quality(Printer, Settings, True),
    known(noise, Deviation),
    normal(Normal, Chance0, Chance),
    Quality is max(0.0, True + Deviation*Normal),
    All = [Quality|Qualities].

%   The Box-Muller transform.

normal(Normal, Chance0, Chance) :-
    typhon_prng:chance_float(U, Chance0, Chance1),
    typhon_prng:chance_float(V, Chance1, Chance),
    Normal is sqrt(-2*log(U)) * cos(2*pi*V).

actions(Actions) :-
    findall(set(Place, Level),
            ( levels(Place, Levels), member(Level, Levels) ),
            Changes),
    Actions = [again|Changes].

act(again, page(Settings, Qualities, Chance), State) :-
    printed(Settings, Qualities, Chance, State).
act(set(Place, Level), State0, State) :-
    State0 = page(Settings0, _, _),
    replaced(Place, Settings0, Level, Settings),
    act(use(Settings), State0, State).
act(use(Settings), page(Settings0, Qualities0, Chance), State) :-
    (   Settings == Settings0
    ->  Qualities = Qualities0
    ;   Qualities = []
    ),
    printed(Settings, Qualities, Chance, State).

replaced(1, [_|Settings], Level, [Level|Settings]) :-
    !.
replaced(Place, [Same|Settings0], Level, [Same|Settings]) :-
    Next is Place - 1,
    replaced(Next, Settings0, Level, Settings).

sensed(page(Settings, [Quality|_], _), sv(Printer, Settings, Quality)) :-
    printer(Printer).

weight(sv(_, _, Quality0), sv(_, _, Quality), Weight) :-
    Weight is Quality - Quality0.

reached(page(_, Qualities, _)) :-
    known(pages, Pages),
    length(Last, Pages),
    append(Last, _, Qualities),
    !,
    sum_list(Last, Sum),
    known(good, Good),
    Sum/Pages >= Good.

shareable(Steps, Units) :-
    Steps = [step(Vector, _, _, _)|_],
    !,
    unit(Vector, 0, First),
    findall(Unit,
            ( member(step(_, _, Page, Weight), Steps),
              unit(Page, Weight, Unit) ),
            Rest),
    Units = [First|Rest].
shareable([], []).

unit(sv(Printer, Settings, Quality), Weight0,
     unit(Printer, Settings, Quality)-Weight) :-
    Weight is max(0, Weight0).
