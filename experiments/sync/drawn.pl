%   Pictures of single runs, one below the other: data of gallery.gp and
%   run.gp.
%
%   Expects: ground.pl, and row_title/3.  Gives: the measure `drawn`, and
%   the tables `starts`, `hosts`, `names`, `bands`, `taus` with a block for
%   each run.

:- use_module('../engine/gnuplot', [colour/2, lighten/2]).

measure(drawn, View, drawn(View.hosts, View.executions, View.rows,
                           View.segments, View.steps, View.failures)).

%   gallery(+Subtitle, +Count, -Picture): Count runs of the first seed.
%   one_run(+Subtitle, -Picture): one run.

gallery(Subtitle, Count, script('gallery.gp', [ starts-starts, hosts-hosts,
                                                names-names ],
                                [ seed(first), size(1400, Height),
                                  variables(of_runs(Subtitle)) ])) :-
    Height is 105 + 290*Count.

one_run(Subtitle, script('run.gp', [ starts-starts, hosts-hosts, names-names,
                                     bands-bands, tau-taus ],
                         [ seed(first), size(1200, 1000),
                           variables(of_runs(Subtitle)) ])).

of_runs(Subtitle, Runs, [ 'SUBTITLE'-Text, rows-Count, end-End, most-Most,
                          hosts-Hosts, 'Row'-Titles, 'Failed'-Failed ]) :-
    Runs = [run(_, Seed, _)|_],
    format(atom(Text), '~w; seed ~w', [Subtitle, Seed]),
    length(Runs, Count),
    findall(Time, ( member(run(_, _, Ms), Runs), get_dict(total, Ms, Time) ),
            Times),
    max_list(Times, End),
    starts(Runs, Starts),
    aggregate_all(max(Top), member([_, Top|_], Starts), Most),
    aggregate_all(max(N), ( member(run(_, _, Ms), Runs),
                            arg(1, Ms.drawn, All), length(All, N) ), Hosts),
    findall(Title, ( member(run(Case, _, Ms), Runs),
                     row_title(Case, Ms, Title) ), Titles),
    findall(Time, ( member(run(_, _, Ms), Runs), failed_at(Ms, Time) ),
            Failed).

%   healed_title(+Name, +Delta, +Measures, -Title): the result of a failure.

healed_title(Name, Delta, Ms, Title) :-
    format(string(Title), "{/:Bold ~w (δ = ~w)}   ~d of ~d lost executions \c
repeated in ~1f s, {/:Italic τ} = ~d meanwhile",
           [Name, Delta, Ms.redone, Ms.lost, Ms.healing_time,
            Ms.healing_tau]).

failed_at(Measures, Time) :-
    (   get_dict(failed_at, Measures, Time)
    ->  true
    ;   Time = -1
    ).

                /*******************************
                *             DATA             *
                *******************************/

%   blocks(+Runs, :Rows, -All): call(Rows, Drawn, List) for each.

:- meta_predicate blocks(+, 2, -).

blocks(Runs, Goal, All) :-
    findall([Rows, [gap, gap]],
            ( member(run(_, _, Ms), Runs), call(Goal, Ms.drawn, Rows) ),
            Lists0),
    append(Lists0, Lists),
    append(Lists, All).

%   For each second a stack of bars, one for each task that began:
%   middle, top, left, right, bottom, top, colour.

starts(Runs, Rows) :-
    blocks(Runs, run_starts, Rows).

run_starts(Drawn, Rows) :-
    arg(2, Drawn, Executions),
    findall(Second-Task,
            ( member(execution(Task, _, Start, _), Executions),
              Second is floor(Start) ),
            Starts0),
    msort(Starts0, Starts),
    counted(Starts, Counts),
    foldl(stacked, Counts, Rows, none-0, _).

counted(Items, Counts) :-
    findall(Item-1, member(Item, Items), Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(Item-Count, ( member(Item-Ones, Groups), length(Ones, Count) ),
            Counts).

stacked((Second-Task)-Count, [Middle, Top, Second, Right, Bottom, Top, Colour],
        Second0-Top0, Second-Top) :-
    ( Second == Second0 -> Bottom = Top0 ; Bottom = 0 ),
    Top is Bottom + Count,
    Middle is Second + 0.5,
    Right is Second + 1,
    task_colour(Task, Colour).

task_colour(Task, Colour) :-
    I is (Task - 1) mod 6,
    colour(I, Colour).

%   Required tasks, in a light colour, and executed tasks: middle, host,
%   from, to, low, high, colour.

hosts(Runs, Rows) :-
    blocks(Runs, run_hosts, Rows).

run_hosts(drawn(Hosts, Executions, _, Segments, _, _), Rows) :-
    findall(Host-Index, nth1(Index, Hosts, Host), Numbers),
    list_to_assoc(Numbers, Assoc),
    findall([Middle, Index, From, To, Low, High, Colour],
            ( bar(Executions, Segments, Host, From, To, Colour),
              get_assoc(Host, Assoc, Index),
              Middle is (From + To)/2,
              Low is Index - 0.5,
              High is Index + 0.5 ),
            Rows).

bar(_, Segments, Host, From, To, Light) :-
    member(segment(Host, Task, From, To), Segments),
    task_colour(Task, Colour),
    lighten(Colour, Light).
bar(Executions, _, Host, From, To, Colour) :-
    member(execution(Task, Host, From, To), Executions),
    task_colour(Task, Colour).

%   Names of tasks at their starts; of repeated tasks, lower.

names(Runs, Rows) :-
    blocks(Runs, run_names, Rows).

run_names(drawn(_, _, TaskRows, _, _, _), Rows) :-
    findall([First, Height, Name, Colour],
            ( nth1(I, TaskRows, task(Task, First, _, _, _, _)),
              name_height(TaskRows, I, Task, Height),
              format(string(Name), 'T~w', [Task]),
              task_colour(Task, Colour) ),
            Rows).

name_height(Rows, I, Task, Height) :-
    (   nth1(Again, Rows, task(Earlier, _, _, _, _, none)),
        Again < I,
        Earlier >= Task
    ->  Height = 1.03
    ;   Height = 1.14
    ).

%   Times in which all agents only observe: from, to, seconds.

bands(Runs, Rows) :-
    blocks(Runs, run_bands, Rows).

run_bands(drawn(_, _, TaskRows, _, _, _), [[-1, -1, 0]|Rows]) :-
    findall([End, To, Idle],
            ( member(task(_, _, _, End, _, Idle), TaskRows),
              number(Idle), Idle > 0, To is End + Idle ),
            Rows).

taus(Runs, Rows) :-
    blocks(Runs, run_tau, Rows).

run_tau(drawn(_, _, _, _, Steps, _), Rows) :-
    findall([Time, Tau], member(Time-Tau, Steps), Rows).
