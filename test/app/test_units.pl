:- module(test_units, []).

% What service managers and Kubernetes start: units, a manifest, and the script
% of the image, beside the command line that they call.

:- use_module('../lib/common').

:- needs([units]).

:- use_module('../lib/texts', [file_lines/2, write_file/2]).
:- use_module('../../app/typhon/commands', [option/5]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [chmod/2, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

unit('app/packaging/systemd/typhon@.service').
unit('app/packaging/systemd/typhon-host@.service').

fleet_unit(Lines) :-
    project_file('app/packaging/systemd/typhon-host@.service', File),
    file_lines(File, Lines).

manifest('app/packaging/kubernetes/typhon.yaml').

%   words(+Text, -Words)

words(Text, Words) :-
    split_string(Text, " \n\\", " \n\\", Parts),
    findall(Part, ( member(Part, Parts), Part \== "" ), Words).

%   options_exist(+Command, +Words): each option among Words is one of Command.

options_exist(Command, Words) :-
    forall(( member(Word, Words), string_concat("--", Text, Word) ),
           ( split_string(Text, "=", "", [Name|_]),
             split_string(Name, "-", "", Parts),
             atomic_list_concat(Parts, '_', Option),
             assertion(option(Command, Option, _, _, _)) )).

run(Program, Args, Status, Text) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(pipe(Out)), stderr(pipe(Err)),
                     process(Pid) ]),
    read_string(Out, _, Text1),
    read_string(Err, _, Text2),
    close(Out),
    close(Err),
    process_wait(Pid, Status),
    string_concat(Text1, Text2, Text).

:- begin_tests(units).

test(systemd_reads_the_unit,
     [ forall(unit(Name)), true(Status-Text == exit(0)-"") ]) :-
    project_file(Name, File),
    run(path('systemd-analyze'), [verify, File], Status, Text).
test(host_of_a_fleet_is_started_again_and_stops_in_time) :-
    fleet_unit(Lines),
    forall(member(Line, [ "Restart=always", "RestartSec=1",
                          "KillSignal=SIGTERM", "TimeoutStopSec=60",
                          "LoadCredential=redis:/etc/typhon/redis" ]),
           assertion(memberchk(Line, Lines))).
test(password_is_in_no_environment_and_no_argument) :-
    fleet_unit(Lines),
    forall(( member(Line, Lines), sub_string(Line, _, _, _, "assword") ),
           assertion(( string_concat("#", _, Line)
                     ; sub_string(Line, _, _, _,
                                  "--password-file=%d/redis") ))).
test(units_have_the_same_walls) :-
    findall(Walls,
            ( unit(Name), project_file(Name, File), file_lines(File, Lines),
              append(_, ["CapabilityBoundingSet="|Walls], Lines) ),
            [Walls1, Walls2]),
    assertion(Walls1 == Walls2).
test(unit_calls_options_that_exist, [forall(unit(Name))]) :-
    project_file(Name, File),
    read_file_to_string(File, Text, []),
    once(sub_string(Text, Before, _, _, "ExecStart=")),
    sub_string(Text, Before, _, 0, Rest),
    once(sub_string(Rest, End, _, _, "\nKillSignal")),
    sub_string(Rest, 0, End, _, Start0),
    (   sub_string(Start0, Stop, _, _, "ExecStop=")
    ->  sub_string(Start0, 0, Stop, _, Start)
    ;   Start = Start0
    ),
    words(Start, Words),
    assertion(memberchk("host", Words)),
    options_exist(host, Words).

:- end_tests(units).

                /*******************************
                *          THE IMAGE           *
                *******************************/

%   image(+Args, +Environment, -Words): the script of the image calls the
%   command line with Words.

image(Args, Environment, Words) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, swipl, Swipl),
          write_file(Swipl, '#!/bin/sh\nshift\nprintf "%s\\n" "$@"\n'),
          chmod(Swipl, +x),
          getenv('PATH', Path0),
          atomic_list_concat([Dir, Path0], :, Path),
          project_file('app/packaging/container/typhon', Script),
          process_create(path(sh), [Script|Args],
                         [ env(['PATH'=Path|Environment]),
                           stdout(pipe(Out)), process(Pid) ]),
          read_string(Out, _, Text),
          close(Out),
          process_wait(Pid, exit(0)) )),
    split_string(Text, "\n", "\n", Words).

%   environment(-Environment): what the manifest gives to typhon-0.

environment(Environment) :-
    manifest(Name),
    project_file(Name, File),
    file_lines(File, Lines),
    findall(Variable=Value, set(Lines, Variable, Value), Environment).

set(Lines, Variable, Value) :-
    member(Line, Lines),
    split_string(Line, "", " -{}", [Inner]),
    string_concat("name: TYPHON_", Rest, Inner),
    split_string(Rest, ",", " ", [Short, Text0]),
    string_concat("value: ", Text, Text0),
    given(Text, Value),
    atom_concat('TYPHON_', Short, Variable).
set(_, 'TYPHON_ADVERTISE', 'typhon-0.typhon.default.svc').

given("$(POD_NAME", 'typhon-0') :-
    !.
given("$(POD_NAME)", 'typhon-0') :-
    !.
given(Text, Value) :-
    split_string(Text, "", "\"", [Plain]),
    atom_string(Value, Plain).

:- begin_tests(image).

test(manifest_gives_what_the_image_reads) :-
    environment(Environment),
    assertion(memberchk('TYPHON_NAME'='typhon-0', Environment)),
    project_file('app/packaging/container/typhon', Script),
    read_file_to_string(Script, Text, []),
    forall(member(Variable=_, Environment),
           assertion(sub_string(Text, _, _, _, Variable))).
test(host_gets_options_that_exist, true(Missing == [])) :-
    environment(Environment),
    image([host], Environment, Words),
    options_exist(host, Words),
    findall(Option,
            ( member(Option, [ "host", "typhon-0", "--fleet=lab",
                               "--redis=redis:6379", "--journal=redis",
                               "--tags=worker", "--stop-seconds=50",
                               "--password-file=/run/secrets/typhon/redis",
                               "--advertise=typhon-0.typhon.default.svc",
                               "--bind=0.0.0.0", "--port=9700" ]),
              \+ memberchk(Option, Words) ),
            Missing).
test(host_without_a_fleet_has_no_option_of_one, true(Words == Expected)) :-
    image([host], ['TYPHON_NAME'=a, 'TYPHON_BIND'='10.0.0.5'], Words),
    Expected = ["host", "a", "--bind=10.0.0.5", "--port=9700",
                "--journal=/var/lib/typhon/journal"].
test(probes_ask_the_host_itself,
     [ forall(member(Word-Words0,
                     [ healthy-["remote", "typhon-0@localhost:9700", "true"],
                       here-["fleet", "here", "typhon-0@localhost:9700"],
                       drain-["fleet", "drain", "typhon-0@localhost:9700"] ])),
       true(Words == Words0) ]) :-
    environment(Environment),
    image([Word], Environment, Words).
test(other_commands_are_passed_on, true(Words == ["agents", "--host=a b"])) :-
    image([agents, '--host=a b'], [], Words).

:- end_tests(image).

                /*******************************
                *          KUBERNETES          *
                *******************************/

%   validated(+Version, +File, -Status, -Text)

validated(Version, File, Status, Text) :-
    project_file('.ci/kubernetes-validate', Script),
    run(Script, ['--where'], exit(0), Where0),
    split_string(Where0, "", "\n", [Where]),
    atomic_list_concat([Where, '/bin/kubernetes-validate'], Program),
    run(Program, ['--strict', '--quiet', '-k', Version, File], Status, Text).

there :-
    missing([kubernetes], []),
    !.
there :-
    format(user_error, '% skipped: there is no kubernetes-validate~n', []),
    fail.

:- begin_tests(kubernetes, [condition(test_units:there)]).

test(manifest_has_the_published_schema,
     [ forall(member(Version, ['1.29', '1.34', '1.37'])),
       true(Status-Text == exit(0)-"") ]) :-
    manifest(Name),
    project_file(Name, File),
    validated(Version, File, Status, Text).
test(mistake_is_found,
     [ forall(member(Old-New, [ 'replicas: 3'-'replcias: 3',
                                'port: 9700 }'-'port: x }',
                                'serviceName: typhon'-'service: typhon'
                              ])) ]) :-
    manifest(Name),
    project_file(Name, File),
    read_file_to_string(File, Text, []),
    atomic_list_concat(Parts, Old, Text),
    assertion(Parts = [_, _]),
    atomic_list_concat(Parts, New, Changed),
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'typhon.yaml', Other),
          write_file(Other, Changed),
          validated('1.34', Other, Status, _) )),
    assertion(Status \== exit(0)).

:- end_tests(kubernetes).
