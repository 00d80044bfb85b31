:- module(test_replays, []).
:- use_module('../../lib/common').
:- use_module('../../lib/study_files',
              [save_lines/3, study_command/4, with_study_file/4]).
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> Replays of the runs of a study */

study([ 'study(walks, "Walks <b>").',
        'overlay(\'steps\', bar, log(step(N)), N).',
        'vary(hosts, [4, 5]).',
        'network(Case, ring(N), [hop_time(uniform(0.1, 0.5))]) :-',
        '    N = Case.hosts.',
        'run(_, Network) :-',
        '    typhon:network_property(Network, hosts([Home|_])),',
        '    typhon:agent_create(agents(strider), A, [host(Home)]),',
        '    typhon:agent_join(A, done, 1000).',
        'measure(hosts, Log, Count) :- length(Log.hosts, Count).' ]).

agent([ ':- agent(strider, []).',
        'main :- walk(7).',
        'walk(0) :- !.',
        'walk(N) :- next_host(random, Host), move(Host), log(step(N)),',
        '    N1 is N-1, walk(N1).' ]).

with_replay(Options, Out, Goal) :-
    study(Lines),
    agent(Agent),
    with_study_file(Lines, Dir, File,
        ( save_lines(Dir, 'strider.pl', Agent),
          study_command(Dir, [File, '--runs', 1, '--out', out|Options],
                        exit(0), _),
          directory_file_path(Dir, out, Out),
          Goal )).

:- meta_predicate with_replay(+, -, 0).

text(Out, Name, Text) :-
    directory_file_path(Out, Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

tools_there :-
    project_file('prolog/typhon/tools/page/www/uPlot.iife.min.js', File),
    exists_file(File).

:- begin_tests(replays, [condition(tools_there)]).

test(linked_and_complete) :-
    with_replay(['--replays'], Out,
        ( text(Out, 'index.html', Page),
          lacks(Page, ["walks/replay.html"], Unlinked),
          assertion(Unlinked == []),
          text(Out, 'walks/replay.html', Replay),
          lacks(Replay, ["\"left\"", "\"link\"", "step(7)", "\"steps\"",
                         "<title>Walks &lt;b&gt;</title>"], Missing),
          assertion(Missing == []),
          aggregate_all(count, sub_string(Replay, _, _, _, "[7 ]"), Sevens),
          assertion(Sevens == 1),             % declared once
          directory_file_path(Out, 'walks/replay.log', Log),
          assertion(\+ exists_file(Log)) )).
test(replays_are_made_on_request_only) :-
    with_replay([], Out,
        ( text(Out, 'index.html', Page),
          lacks(Page, ["replay.html"], Missing),
          assertion(Missing == ["replay.html"]) )).

lacks(Text, Parts, Missing) :-
    findall(Part, ( member(Part, Parts), \+ sub_string(Text, _, _, _, Part) ),
            Missing).

:- end_tests(replays).
