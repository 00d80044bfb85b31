:- module(test_output_files, []).

% All that writes a file leaves alone what is another thing than its output.

:- use_module('../../../../app/packaging/parts', [installed/1]).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/authority').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/page), [page_export/3]).
:- use_module('../../../../app/typhon/keys', [keys_sign_file/3]).
:- use_module('../../../../app/typhon/picture', [picture/3]).

:- needs([openssl]).

:- begin_tests(output_files).

%   Each has a file of each other kind, an agent program, and its own input.

test(other_files_are_kept,
     [ forall(writes(Kind, _)) ]) :-
    no_leaks(with_tmp_dir(tried(Kind))).
%   A page needs its tools.

test(own_output_is_written_again, 
     [ forall(( writes(Kind, _), Kind \== page )) ]) :-
    no_leaks(with_tmp_dir(twice(Kind))).
test(log_is_extended_only_if_it_is_one,
     error(permission_error(overwrite, log, _))) :-
    with_tmp_dir(extended).
test(signature_is_not_written_over_another_file) :-
    with_authority([], [alice], signed).
test(options_of_a_running_host_as_well,
     error(permission_error(overwrite, audit, _))) :-
    with_hosts([alpha], with_tmp_dir(changed)).

:- end_tests(output_files).

%   writes(?Kind, :Goal): call(Goal, Log, File) writes an output of Kind to
%   File; Log is a log.

writes(log, logged).
writes(network_log, network_logged).
writes(audit, audited).
writes(page, paged) :-
    installed(replay).
writes(picture, pictured).
writes(saved_network, saved).
writes(restore_point, restored).

logged(_, File) :-
    log_server_start([file(File)], Address),
    log_server_stop(Address).

network_logged(_, File) :-
    setup_call_cleanup(network_start(line(2), N, [log(File)]), true,
                       network_stop(N)).

audited(_, File) :-
    host_start(alpha, [audit(File)]),
    host_stop(alpha).

paged(Log, File) :-
    page_export(Log, File, []).

pictured(Log, File) :-
    picture(Log, File, []).

saved(_, File) :-
    setup_call_cleanup(network_start(line(2), N, []), network_save(N, File),
                       network_stop(N)).

restored(_, File) :-
    with_hosts([alpha],
               ( create([(main :- receive(go))], Agent),
                 wait_state(Agent, waiting),
                 agent_save(Agent, File) )).

log_in(Dir, Log) :-
    file_with(Dir, 'log.pl', "event(0.5,'a@h:1','x.1@a@h:1',born('a@h:1')).\n\c
              event(1.5,'a@h:1','x.1@a@h:1',ended(done)).\n", Log).

tried(Kind, Dir) :-
    log_in(Dir, Log),
    writes(Kind, Writer),
    forall(( other(Kind, Name, Text), Text \== own
           ; \+ memberchk(Kind, [log, network_log]), Name = log, Text = own ),
           ( ( Text == own -> File = Log ; file_with(Dir, Name, Text, File) ),
             read_file_to_string(File, Before, []),
             catch(call(Writer, Log, File), error(Formal, _), true),
             assertion(subsumes_term(permission_error(overwrite, _, _), Formal)),
             read_file_to_string(File, After, []),
             assertion(Before == After) )).

other(_, 'agent.pl', ":- agent(a, []).\nmain :- leave(x).\n").
other(_, 'notes.txt', "e").
other(_, 'bytes', "\u0001\u0002").
other(Kind, Name, Text) :-
    member(Name-Text,
           [ page-"<!doctype html>\n<p>", picture-"<svg xmlns=''/>",
             audit-"audit(1, a, b, c, d).\n",
             saved_network-"typhon_saved(1, 90004, x).\n",
             restore_point-"restore_point(1).\n",
             signature-"signed(a, b).\n" ]),
    Name \== Kind.

twice(Kind, Dir) :-
    log_in(Dir, Log),
    writes(Kind, Writer),
    file_with(Dir, out, "", File),
    call(Writer, Log, File),
    call(Writer, Log, File).

extended(Dir) :-
    file_with(Dir, 'a.pl', ":- agent(a, []).\n", File),
    log_server_start([file(File), mode(append)], _).

changed(Dir) :-
    file_with(Dir, 'a.pl', ":- agent(a, []).\n", File),
    host_change(alpha, audit(File)).

signed(Authority) :-
    file_with(Authority, 'a.pl', ":- agent(a, []).\nmain :- leave(x).\n", File),
    keys_sign_file(File, alice, Authority),
    keys_sign_file(File, alice, Authority),
    file_with(Authority, 'a.pl.sig', "another thing", _),
    catch(keys_sign_file(File, alice, Authority), error(Formal, _), true),
    assertion(subsumes_term(permission_error(overwrite, signature, _), Formal)).

file_with(Dir, Name, Text, File) :-
    directory_file_path(Dir, Name, File),
    write_file(File, Text).
