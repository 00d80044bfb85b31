%   Figures 4.9, 4.10, 4.12, 4.13: networks beside each other, and sharing
%   as time passes.
%
%   Expects: ground, and the parameters `network` and `density`, which vary.

:- use_module('../engine/gnuplot', [colour/2]).

label(trend, "Sharing events at the end against the beginning (%)").
label(wall(50), "50 hosts, obstacle").
label(N, Text) :-
    vary(network, Networks),
    member(N, Networks),
    integer(N),
    format(string(Text), "~d hosts", [N]).

%   The linear trend of sharing events in 30 equal parts of the run.

measure(trend, View, Percent) :-
    shared_times(View.learners, Times),
    duration(View.learners, End),
    trend_line(Times, End, Level, Last),
    Level > 0,
    Percent is 100*(Last - Level)/Level.

trend_line(Times, End, Level, Last) :-
    bins(Times, End, 30, Points),
    trend(Points, Slope, Level),
    Last is Level + Slope*End.

%   each_network(+Said, -Network, -Text): for claims of every network.

each_network(Said, Network, Text) :-
    vary(network, Networks),
    member(Network, Networks),
    label(Network, Name),
    format(string(Text), "~w, ~w", [Said, Name]).

%   first_drop(+Measure, -Test): the fall from D 0.1 to 0.2 is the largest.

first_drop(Measure, at([density=0.1], (First > A, First > B, First > C))) :-
    drop(Measure, 0.1, 0.2, First),
    drop(Measure, 0.2, 0.3, A),
    drop(Measure, 0.3, 0.4, B),
    drop(Measure, 0.4, 0.5, C).

drop(Measure, D1, D2,
     at([density=D1], Measure) - at([density=D2], Measure)).

                /*******************************
                *           PICTURES           *
                *******************************/

%   sets(+Name, +Measure, -Picture): a set of points for each network, one
%   for each density, as in the thesis.

sets(Name, Measure,
     script('sets.gp',
            [ Medians-set_rows(Measure), All-set_runs(Measure),
              Printed-set_printed(Measure) ],
            [size(1100, 470), variables(sets_drawn(Measure))])) :-
    maplist(atom_concat(Name), ['-medians', '-runs', '-printed'],
            [Medians, All, Printed]).

set_at(Network, Density, At) :-
    vary(network, Networks),
    nth0(I, Networks, Network),
    At is 6*I + 10*Density.

of_network(Network, Runs, Density, Values, Measure) :-
    findall(D, member(run(_{network:Network, density:D}, _, _), Runs), _),
    findall(D, ( member(run(Case, _, _), Runs), Case.network == Network,
                 D = Case.density ), Ds0),
    sort(Ds0, Ds),
    member(Density, Ds),
    findall(V, ( member(run(Case, _, Ms), Runs), Case.network == Network,
                 Case.density =:= Density, get_dict(Measure, Ms, V) ),
            Values).

set_rows(Measure, Runs, Rows) :-
    blocks(Runs,
           [N, D, Vs, [At, Median, Least, Most]]>>
               ( spread(Vs, Least, Median, Most), set_at(N, D, At) ),
           Measure, Rows).
