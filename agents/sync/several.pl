:- module(sync_several,
          [ sequences_start/3           % +Sequences, +Options, -Agents
          ]).
:- use_module(operator, [sequence_start/5]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2, memberchk/2, nextto/3]).
:- use_module(library(option), [merge_options/3, option/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(ugraphs), [top_sort/2, vertices_edges_to_ugraph/3]).

/** <module> Several sequences of tasks that share hosts and wait for each
other

Beyond the thesis, which names it in section 8.2.  Each sequence has agents of
its own, which know nothing of the others (dependence.pl).

*Threading*: any thread.
*/

%!  sequences_start(+Sequences, +Options, -Agents:list(list)) is det.
%
%   Sequences are sequence(Name, Hosts, Tasks, Own), each as for
%   sequence_start/5; Options are the defaults for the options Own.  Agents has
%   a list of agents for each sequence.
%
%   With the option pool(Name) for all of them no host executes two tasks at
%   once.  With after(Pairs) tasks wait for tasks of other sequences; the
%   order of all tasks is checked for cycles.
%
%   @error existence_error(task, Sequence:Task): `after` names an unknown task
%   @error domain_error(order_of_tasks, Tasks): tasks wait for each other in a
%   cycle
%   @error errors of sequence_start/5

sequences_start(Sequences, Options, Agents) :-
    must_be(list, Sequences),
    check_order(Sequences),
    maplist(start(Options), Sequences, Agents).

start(Options, sequence(Name, Hosts, Tasks, Own0), Agents) :-
    merge_options(Own0, Options, Own),
    sequence_start(Name, Hosts, Tasks, Own, Agents).

check_order(Sequences) :-
    findall(Name:Task,
            ( member(sequence(Name, _, Tasks, _), Sequences),
              member(Task-_, Tasks) ),
            All),
    findall(First-Next, earlier(Sequences, First, Next), Edges),
    forall(( member(First-_, Edges), \+ memberchk(First, All) ),
           existence_error(task, First)),
    vertices_edges_to_ugraph(All, Edges, Graph),
    (   top_sort(Graph, _)
    ->  true
    ;   pairs_keys(Edges, Waiting0),
        sort(Waiting0, Waiting),
        domain_error(order_of_tasks, Waiting)
    ).

earlier(Sequences, Name:First, Name:Next) :-
    member(sequence(Name, _, Tasks, _), Sequences),
    nextto(First-_, Next-_, Tasks).
earlier(Sequences, Other:First, Name:Task) :-
    member(sequence(Name, _, _, Options), Sequences),
    option(after(Afters), Options, []),
    member(Task-(Other:First), Afters).
