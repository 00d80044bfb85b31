:- module(test_upgrading, []).

% UPGRADING.md: files that earlier versions have written are read. Folders of
% earlier/ have the names of versions; their files are of one agent that waits
% for `go`, of a network in virtual time, of a host, and of a log.

:- use_module('../lib/common').
:- use_module('../lib/fixtures', [facts/2, joined/2, with_hosts/2]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

version(Version) :-
    project_file('test/project/earlier', Dir),
    directory_member(Dir, Path, []),
    file_base_name(Path, Version).

written(Version, Name, File) :-
    format(atom(Relative), 'test/project/earlier/~w/~w', [Version, Name]),
    project_file(Relative, File).

notes(Agent, Notes) :-
    facts(Agent, Facts),
    findall(Note, member(note(Note), Facts), Notes).

%   journal(+Version, +Dir): make the journal of Version in Dir.

journal(Version, Dir) :-
    written(Version, 'journal.sql', File),
    make_directory(Dir),
    directory_file_path(Dir, 'journal.db', Base),
    atom_concat('.read ', File, Read),
    process_create(path(sqlite3), [Base, Read], []).

%   Records of a journal are those of the version that wrote it.

same_records :-
    current_prolog_flag(address_bits, 64),
    current_prolog_flag(version, Version),
    Version < 90300,
    missing([journal], []).

loaded_agent(File, Outcome-Result) :-
    agent_load(File, Agent),
    agent_send(Agent, go),
    joined(Agent, Outcome),
    agent_result(Agent, Result, 10).

continued(Network, network(Notes, Outcome, Result)) :-
    notes(bob, Notes),
    agent_join(amy, Outcome, 200),
    agent_result(amy, Result, 10),
    network_stop(Network).

:- begin_tests(upgrading).

test(restore_points_are_read,
     [forall(version(Version)), Result == done-[milk,eggs]]) :-
    written(Version, 'agent.txt', File),
    with_hosts([alpha], loaded_agent(File, Result)).

test(saved_networks_continue,
     [ forall(version(Version)),
       Saved =@= network([milk,f(X,X,"text",1.5)], done, woke(100.0)) ]) :-
    written(Version, 'network.txt', File),
    no_leaks(( network_load(File, Network, []),
               continued(Network, Saved) )).

test(journals_are_restored,
     [ forall(version(Version)), condition(same_records),
       Notes-Fact =@= [milk,f(X,X,"text",1.5)]-1 ]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, journal, Journal),
          journal(Version, Journal),
          with_hosts([alpha-[journal(Journal)]],
                     ( notes(bob, Notes),
                       remote(alpha, sense(fact(Fact))) )) )).

test(logs_are_read,
     [forall(version(Version)), What == [created,ended(done)]]) :-
    written(Version, 'log.txt', File),
    log_events(File, Events),
    findall(One, member(event(_, _, _, One), Events), What).

test(each_version_is_documented, [forall(version(Version))]) :-
    project_file('UPGRADING.md', File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    format(string(Column), "| of ~w |", [Version]),
    once(sub_string(Text, _, _, _, Column)).

:- end_tests(upgrading).
