:- module(test_downloads, []).

% What is downloaded has a version and a checksum in the tree, or a signature of
% Debian; what is deployed has what cells need.

:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/2, file_lines/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [ chmod/2, directory_file_path/3, directory_member/3,
                make_directory_path/1 ]).
:- if(exists_source(library(json))).
:- use_module(library(json), [json_read_dict/2]).
:- else.
:- use_module(library(http/json), [json_read_dict/2]).
:- endif.
:- use_module(library(lists), [append/2, last/2, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

                /*******************************
                *             FILES            *
                *******************************/

text(Name, Text) :-
    project_file(Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

%   tracked(-Names): the files of the project, without what runs have made.

tracked(Names) :-
    project_file('.', Root),
    process_create(path(git), ['ls-files', '-co', '--exclude-standard'],
                   [cwd(Root), stdout(pipe(Out)), process(Pid)]),
    call_cleanup(read_string(Out, _, Text), close(Out)),
    process_wait(Pid, exit(0)),
    split_string(Text, "\n", "\n", Names).

%   Commands are in the files that are neither programs in Prolog nor documents.

commands_file(Name) :-
    tracked(Names),
    member(Name, Names),
    \+ ( member(End, [".pl", ".md", ".json", ".csv", ".svg", ".png", ".java",
                      ".gold", ".js", ".css", ".html", ".txt", ".in"]),
         string_concat(_, End, Name) ),
    project_file(Name, File),
    exists_file(File).

%   command(-Name, -Words) is nondet: a line of a file, with those it continues
%   in, that is no comment.

command(Name, Words) :-
    commands_file(Name),
    catch(text(Name, Text), error(_, _), fail),
    split_string(Text, "\n", "", Lines0),
    joined(Lines0, Lines),
    member(Line, Lines),
    split_string(Line, " \t", " \t\"'", Words0),
    findall(Word, ( member(Word, Words0), Word \== "" ), Words),
    Words = [First|_],
    \+ string_concat("#", _, First).

joined([Line0,Next|Lines0], Lines) :-
    string_concat(Line1, "\\", Line0),
    !,
    atomics_to_string([Line1, " ", Next], Line),
    joined([Line|Lines0], Lines).
joined([Line|Lines0], [Line|Lines]) :-
    !,
    joined(Lines0, Lines).
joined([], []).

atomics_to_string(Parts, Text) :-
    atomic_list_concat(Parts, Atom),
    atom_string(Atom, Text).

%   calls(+Words, +Program, -Args): Program is called in the words of a line.

calls(Words, Program, Args) :-
    append([Before, [Word], Args], Words),
    file_base_name(Word, Base),
    atom_string(Base, Program),
    \+ ( member(Other, ["echo", "##"]), memberchk(Other, Before) ).

hexadecimal(Text, Length) :-
    string_length(Text, Length),
    forall(( string_code(I, Text, Code), I > 0 ),
           code_type(Code, xdigit(_))).

                /*******************************
                *        REQUIREMENTS          *
                *******************************/

requirements(Name, Lines) :-
    project_file('.ci/requirements', Dir),
    directory_member(Dir, File, [extensions([txt])]),
    file_base_name(File, Name),
    file_lines(File, Lines0),
    joined(Lines0, Lines).

requirement(Name, Line) :-
    requirements(Name, Lines),
    member(Line, Lines),
    Line \== "",
    \+ string_concat("#", _, Line).

%   The names of files are for the message of an assertion.

has(_, Args, Flag) :-
    memberchk(Flag, Args).

has_checksum(_, _, Package) :-
    string_concat("sha512-", _, Package.integrity).

is_pinned(_, Line) :-
    split_string(Line, " ", " ", [Package|Words]),
    split_string(Package, "=", "", [_, "", Version]),
    Version \== "",
    forall(( member(Word, Words), string_concat("--hash=", Hash, Word) ),
           ( string_concat("sha256:", Sum, Hash), hexadecimal(Sum, 64) )),
    once(( member(Word, Words), string_concat("--hash=", _, Word) )).

locked_package(Name, Place, Package) :-
    tracked(Names),
    member(Name, Names),
    string_concat(_, "package-lock.json", Name),
    project_file(Name, File),
    setup_call_cleanup(open(File, read, In),
                       json_read_dict(In, Lock),
                       close(In)),
    get_dict(Place, Lock.packages, Package),
    Place \== ''.

:- begin_tests(downloads).

test(pip_installs_only_what_has_a_hash) :-
    findall(Name-Args,
            ( command(Name, Words), calls(Words, "pip", ["install"|Args]) ),
            Calls),
    assertion(Calls \== []),
    forall(( member(Name-Args, Calls),
             member(Flag, ["--require-hashes", "--no-deps",
                           "--only-binary"]) ),
           assertion(has(Name, Args, Flag))).
test(each_requirement_has_a_version_and_a_hash) :-
    assertion(requirement(_, _)),
    forall(requirement(Name, Line),
           assertion(is_pinned(Name, Line))).
test(each_script_for_pypi_has_requirements) :-
    findall(Name, requirements(Name, _), Names),
    project_file('.ci', Dir),
    forall(( directory_member(Dir, File, []),
             read_link(File, pypi, _) ),
           ( file_base_name(File, Base),
             atom_concat(Base, '.txt', Name),
             assertion(memberchk(Name, Names)) )).
test(npm_installs_only_what_is_locked) :-
    findall(Name-Words,
            ( command(Name, Words),
              member(Program, ["npx", "npm", "yarn", "pnpm"]),
              calls(Words, Program, Args),
              \+ Args = ["ci"|_],
              \+ append([_, ["-v", Program|_]], Words) ),
            Calls),
    assertion(Calls == []).
test(install_scripts_of_npm_do_not_run) :-
    findall(Name-Args,
            ( command(Name, Words), calls(Words, "npm", ["ci"|Args]) ),
            Calls),
    assertion(Calls \== []),
    forall(member(Name-Args, Calls),
           assertion(has(Name, Args, "--ignore-scripts"))).
test(each_locked_package_has_a_checksum) :-
    assertion(locked_package(_, _, _)),
    forall(locked_package(Name, Place, Package),
           assertion(has_checksum(Name, Place, Package))).
test(each_action_is_a_commit) :-
    findall(Words,
            ( command(Name, Words0),
              sub_string(Name, _, _, _, "workflows/"),
              append([_, ["uses:"|Words]], Words0) ),
            Uses),
    assertion(Uses \== []),
    forall(member(Words, Uses), assertion(is_commit(Words))).

is_commit([Action, "#", Version]) :-
    split_string(Action, "@", "", [_, Commit]),
    hexadecimal(Commit, 40),
    string_concat("v", _, Version).

test(each_jar_has_a_version_and_a_checksum) :-
    project_file('bench/peers', Dir),
    findall(File, directory_member(Dir, File, [extensions([jars])]), Files),
    assertion(Files = [_,_|_]),
    forall(( member(File, Files), file_lines(File, Lines),
             member(Line, Lines), Line \== "" ),
           assertion(is_jar(File, Line))).

is_jar(_, Line) :-
    split_string(Line, " ", "", [Sum,Place]),
    hexadecimal(Sum, 64),
    split_string(Place, "/", "", Parts),
    append(_, [Name,Version,File], Parts),
    atomics_to_string([Name, -, Version, '.jar'], File).

%   What curl gets is only another file.

test(changed_jade_is_not_used) :-
    with_tmp_dir(jade_in).

jade_in(Dir) :-
    directory_file_path(Dir, '.m2/repository/net/sf/ingenias/jade/4.3', Jars),
    make_directory_path(Jars),
    directory_file_path(Jars, 'jade-4.3.jar', Jar),
    directory_file_path(Dir, curl, Curl),
    write_file(Curl, '#!/bin/sh\necho changed >"$3"\n'),
    chmod(Curl, +x),
    jade(Dir, ['--get'], Status, Out),
    assertion(Status \== exit(0)),
    assertion(Out == ""),
    assertion(\+ exists_file(Jar)),
    write_file(Jar, 'changed\n'),
    jade(Dir, [], Status1, Out1),
    assertion(Status1-"" == exit(1)-Out1).

jade(Dir, Args, Status, Text) :-
    project_file('bench/peers/jade', Script),
    getenv('PATH', Path0),
    atomic_list_concat([Dir, Path0], :, Path),
    process_create(Script, Args,
                   [ environment(['HOME'=Dir, 'PATH'=Path]), stderr(null),
                     stdout(pipe(Out)), process(Pid) ]),
    call_cleanup(read_string(Out, _, Text), close(Out)),
    process_wait(Pid, Status).

:- end_tests(downloads).

:- begin_tests(deployment).

test(image_has_what_cells_need) :-
    text('Containerfile', Text),
    split_string(Text, " \n\\", " \n\\", Words),
    forall(member(Package, ["bubblewrap", "util-linux", "libseccomp2",
                            "python3"]),
           assertion(memberchk(Package, Words))).
test(image_says_how_cells_are_permitted) :-
    text('Containerfile', Text),
    assertion(sub_string(Text, _, _, _, "seccomp=unconfined")),
    assertion(sub_string(Text, _, _, _, "unmask=ALL")).
test(unit_permits_the_namespaces_of_cells) :-
    findall(N, ( unit('RestrictNamespaces', Words), member(N, Words) ), Ns),
    sort(Ns, Sorted),
    assertion(Sorted == ["cgroup","ipc","mnt","net","pid","user","uts"]).
test(unit_permits_the_calls_of_cells) :-
    findall(Words, unit('SystemCallFilter', Words), Filters),
    last(Filters, Last),
    forall(member(Call, ["@mount", "capset", "seccomp", "sethostname"]),
           assertion(memberchk(Call, Last))),
    assertion(\+ ( member(["~@privileged"|More], Filters),
                   memberchk("@resources", More) )),
    findall(F, ( unit('RestrictAddressFamilies', Fs), member(F, Fs) ), All),
    assertion(memberchk("AF_NETLINK", All)).
test(unit_hides_nothing_of_proc, Found == []) :-
    findall(Option,
            ( member(Option, ['ProtectHostname', 'ProtectKernelLogs',
                              'ProtectKernelTunables', 'ProtectProc',
                              'ProcSubset']),
              unit(Option, _) ),
            Found).

%   unit(+Option, -Words) is nondet: a line of the unit.

unit(Option, Words) :-
    text('app/packaging/systemd/typhon@.service', Text),
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    atom_concat(Option, =, Start),
    string_concat(Start, Value, Line),
    split_string(Value, " ", " ", Words).

:- end_tests(deployment).
