:- module(test_single_life,
          [ life_file/1,                % -File
            life_differences/2          % +Text, -Unexpected
          ]).
:- use_module(library(lists), [subtract/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(common, [project_file/2]).

/** <module> The output of single/life.pl

*Threading*: no state.
*/

%!  life_file(-File) is det.

life_file(File) :-
    project_file('test/lib/single/life.pl', File).

%!  life_differences(+Text, -Unexpected) is det.
%
%   Unexpected is unexpected(More, Missing): facts in Text, printed by that
%   file, that are not expected, and expected facts that it lacks.

life_differences(Text, Unexpected) :-
    split_string(Text, "\n", "\n", Lines),
    maplist(term_string, Found, Lines),
    findall(came(Name, Result), came(Name, Result), Wanted),
    subtract(Found, Wanted, More),
    subtract(Wanted, Found, Missing),
    Unexpected = unexpected(More, Missing).

came(travels, done-here).
came(waits, waiting).
came(timeout, timeout).
came(nothing_can_happen, raised(no_agent_can_run)).
came(asleep, [done]).
came(many_sleep, [done]).
came(refused, capacity).
came(fails, failed).
came(raises, raised).
came(runs_for_a_while, many).
came(always_ready, done).
came(rests, [asked(first),asked(second)]).
came(server_handles, [1,begun]-[2,1,begun]).
came(server_defers, [later,first,begun]).
came(server_raises, oops-[begun]).
came(server_stops_itself, stopped-[begun]).
came(server_times_out, [timeout,soon,begun]).
came(virtual_time_jumps, done-12.0).
came(virtual_timeout, timeout-7.0).
came(virtual_nothing_can_happen, raised(no_agent_can_run)).
came(virtual_random_is_apart, same).
came(virtual_state, virtual/5).
came(virtual_steps, [2.0,4.0,6.0,8.0]).
came(virtual_slices, [0.0,8.0]).
came(virtual_pace, soon-5.0).
came(virtual_program, [there,there,timeout,done,4.0]).
came(virtual_error, done).
came(loaded, []).
