:- module(test_fleet_host, []).

% The command `host` as a member of a fleet.

:- use_module('../lib/common').

:- needs([fleet]).

:- use_module('../lib/redis', [redis_address/2, with_redis/3]).
:- use_module('../lib/texts', [write_file/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil),
              [read_line_to_string/2, read_stream_to_codes/2]).
:- use_module(library(typhon)).

password('a word: "quoted" $HOME').

%   with_engine(-Redis, -File, :Goal): the engine wants the password of File.

:- meta_predicate with_engine(-, -, 0).

with_engine(Redis, File, Goal) :-
    password(Password),
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, password, File),
          write_file(File, Password),
          with_redis(['--requirepass', Password], Redis, Goal) )).

command(Options, Command, [App, host, alpha|Options]) :-
    current_prolog_flag(executable, Command),
    project_file('app/typhon.pl', App).

engine_options(Redis, File,
               ['--fleet', lab, '--redis', Engine, '--password-file', File]) :-
    redis_address(Redis, Address),
    term_to_atom(Address, Text),
    atomic_list_concat(Parts, '\'', Text),
    atomic_list_concat(Parts, Engine).

%   hosting(+Options, -Host, :Goal, -Status): the command runs Host during Goal,
%   and gets SIGTERM.

:- meta_predicate hosting(+, -, 0, -).

hosting(Options, Host, Goal, Status) :-
    command(Options, Program, Args),
    process_create(Program, Args,
                   [stdin(null), stdout(pipe(Out)), process(Pid)]),
    call_cleanup(( read_line_to_string(Out, Line),
                   atom_string(Host, Line),
                   once(Goal),
                   process_kill(Pid, term),
                   wait_for_end(Pid, 60, Status) ),
                 ( close(Out), ended(Pid) )).

ended(Pid) :-
    catch(( process_kill(Pid, kill), process_wait(Pid, _) ),
          error(existence_error(process, _), _), true).

as_member(Redis, Goal) :-
    redis_address(Redis, Address),
    password(Password),
    setup_call_cleanup(fleet_join(lab, [ redis(Address), password(Password),
                                         lease(60) ]),
                       once(Goal),
                       fleet_leave(lab)).

:- meta_predicate as_member(+, 0).

keeper(Host, Agent) :-
    agent_create(clauses([ (:- agent(keeper, [state([k/1])])),
                           (on_message(_, M) :- assertz(k(M))) ]),
                 Agent, [host(Host), static(true)]).

kept(Agent, Ms) :-
    agent_property(Agent, facts(Facts)),
    findall(M, member(k(M), Facts), Ms).

up(Tag, Hosts) :-
    catch(fleet_hosts(lab, Hosts, [tag(Tag), state(up)]),
          error(existence_error(tag, _), _), Hosts = []).

journal(Args, Status, Out, Err) :-
    project_file('app/typhon.pl', App),
    run_swipl([App,journal|Args], [timeout(60)], Status, Out, Err).

:- begin_tests(fleet_host).

test(host_is_known_by_its_tags_until_it_stops, true(Status == exit(0))) :-
    no_leaks(with_engine(Redis, File,
        as_member(Redis,
            ( engine_options(Redis, File, Options0),
              hosting(['--tags=robot,camera'|Options0], Host,
                      forall(member(Tag, [robot, camera]),
                             wait_until(up(Tag, [Host]), 30)),
                      Status),
              wait_until(up(robot, []), 20) )))).
test(agents_go_elsewhere_when_the_host_gets_a_signal,
     true(Outcome-There == done-[Other])) :-
    no_leaks(with_engine(Redis, File,
        as_member(Redis,
            ( host_start(other, [fleet(lab), tags([robot])]),
              host_property(other, address(Other)),
              engine_options(Redis, File, Options),
              agent_create(clauses([ (:- agent(guest, [])),
                                     (main :- receive(_-go), here(H),
                                              leave(was(H))) ]),
                           Agent, [host(other)]),
              hosting(['--tags=robot'|Options], Host, agent_move(Agent, Host),
                      exit(0)),
              agent_send(Agent, go),
              agent_join(Agent, Outcome, 60),
              findall(H, remote(other, take(was(H))), There),
              host_stop(other) )))).
test(journal_in_the_engine_outlives_the_process, true(Got == [kept])) :-
    no_leaks(with_engine(Redis, File,
        as_member(Redis,
            ( engine_options(Redis, File, Options),
              free_port(Port),
              format(atom(At), '--port=~d', [Port]),
              All = [At, '--journal=redis'|Options],
              hosting(All, Host,
                      ( keeper(Host, Agent),
                        agent_send(Agent, kept),
                        wait_until(kept(Agent, [kept]), 20),
                        journal([alpha|Options], exit(1), _, Running),
                        assertion(sub_string(Running, _, _, _,
                                             "another process has it")) ),
                      exit(0)),
              journal([alpha,'--agents'|Options], exit(0), Lines, ""),
              assertion(sub_string(Lines, 0, _, _, "keeper.")),
              hosting(All, Host, kept(Agent, Got), exit(0)) )))).
test(journal_that_the_engine_does_not_have, true(Status == exit(1))) :-
    with_engine(Redis, File,
        ( engine_options(Redis, File, Options),
          journal([beta|Options], Status, "", Err),
          assertion(sub_string(Err, _, _, _, "lab/beta")) )).
test(password_is_no_argument_and_in_no_environment) :-
    with_engine(Redis, File,
        ( engine_options(Redis, File, Options),
          hosting(Options, _, hidden, exit(0)) )).

hidden :-
    password(Password),
    expand_file_name('/proc/[0-9]*', Dirs),
    current_prolog_flag(pid, Me),
    forall(( member(Dir, Dirs),
             atom_concat('/proc/', Pid, Dir),
             \+ atom_number(Pid, Me),
             process_file(Dir, cmdline, Args),
             sub_string(Args, _, _, _, "app/typhon.pl"),
             member(Name, [cmdline, environ]),
             process_file(Dir, Name, Text) ),
           assertion(\+ sub_string(Text, _, _, _, Password))).

process_file(Dir, Name, Text) :-
    atomic_list_concat([Dir, Name], /, File),
    catch(setup_call_cleanup(open(File, read, In, [encoding(octet)]),
                             read_stream_to_codes(In, Codes),
                             close(In)),
          error(_, _), fail),
    string_codes(Text, Codes).

wrong(['--fleet=lab'], "host needs --redis").
wrong(['--fleet=lab', '--redis=here'], "HOST:PORT expected").
wrong(['--fleet=lab', '--redis=127.0.0.1:1'], "fleet lab cannot be reached").
wrong(['--tags=a'], "host needs --fleet").
wrong(['--journal=redis'], "host needs --fleet").
wrong(['--redis=127.0.0.1:1'], "host needs --fleet").
wrong(['--fleet=lab', '--redis=127.0.0.1:1', '--password-file=/no/such'],
      "/no/such cannot be read").

test(wrong_options_are_one_line, [forall(wrong(Options, Said))]) :-
    refused(Options, Said).
test(wrong_password_is_one_line) :-
    with_engine(Redis, File,
        ( write_file(File, 'another\n'),
          engine_options(Redis, File, Options),
          refused(Options, "does not accept the user and password") )).

refused(Options, Said) :-
    command(Options, Program, Args),
    process_create(Program, Args,
                   [ stdin(null), stdout(null), stderr(pipe(Err)),
                     process(Pid) ]),
    read_string(Err, _, Text),
    close(Err),
    process_wait(Pid, Status),
    split_string(Text, "\n", "\n", Lines),
    assertion(Status == exit(1)),
    assertion(Lines = [_]),
    assertion(sub_string(Text, _, _, _, Said)).

:- end_tests(fleet_host).
