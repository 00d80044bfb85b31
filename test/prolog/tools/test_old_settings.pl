:- module(test_old_settings, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(settings)).
:- use_module(library(typhon)).

% A program for an earlier version sets a setting by its old name.

%   old(?Old, ?New): in 0.1.0 the setting had the name Old.

old(typhon_acceptor:strangers, typhon_acceptor:unproved).
old(typhon_auth:handshake_time, typhon_handshake:handshake_time).
old(typhon_base_key_files:certificates, typhon_keys:certificates).
old(typhon_carrier:rest_seconds, typhon_node_process:rest_seconds).
old(typhon_carriers:kill_seconds, typhon_processes:kill_seconds).
old(typhon_carriers:order_seconds, typhon_processes:order_seconds).
old(typhon_carriers:start_seconds, typhon_processes:start_seconds).
old(typhon_contacts:contacts, typhon_peer_cache:contacts).
old(typhon_doubt:settle_seconds, typhon_in_doubt:settle_seconds).
old(typhon_event_shown:content_characters, typhon_host_log:content_characters).
old(typhon_fipa_directory:entries, typhon_fipa_managers:entries).
old(typhon_guard_arguments:ball_cells, typhon_guard_calls:ball_cells).
old(typhon_guard_texts:atom_chars, typhon_guard_limits:atom_chars).
old(typhon_held:held_seconds, typhon_scheduler:blocked_seconds).
old(typhon_held:held_workers, typhon_scheduler:blocked_workers).
old(typhon_hello:records, typhon_handshake:records).
old(typhon_helper_python:python, typhon_helper_process:python).
old(typhon_hop:doubt_seconds, typhon_in_doubt:shown_seconds).
old(typhon_hop:settle_seconds, typhon_in_doubt:settle_seconds).
old(typhon_keeper:connect_time, typhon_connection_manager:connect_time).
old(typhon_keeper:resting, typhon_connection_manager:resting).
old(typhon_keeper:return_time, typhon_connection_manager:return_time).
old(typhon_legacies:clones, typhon_outcomes:clones).
old(typhon_legacies:legacies, typhon_outcomes:results).
old(typhon_legacy:result_bytes, typhon_payloads:result_bytes).
old(typhon_life:faulty, typhon_creation:faulty).
old(typhon_named:met, typhon_questions:met).
old(typhon_nxt_helper:python, typhon_nxt_link:python).
old(typhon_overuse:pause, typhon_quota_enforcer:pause).
old(typhon_refusing:clause_cells, typhon_guard_limits:clause_cells).
old(typhon_ros_open_requests:most, typhon_ros_requests:most).
old(typhon_ros_socket:longest, typhon_ros_rosbridge:longest).
old(typhon_ros_standing:most, typhon_ros_advertisements:most).
old(typhon_survey:seconds, typhon_inventory:seconds).
old(typhon_telling:delay, typhon_event_sender:delay).
old(typhon_telling:events, typhon_watch_senders:events).
old(typhon_telling:patience, typhon_event_sender:patience).
old(typhon_telling:virtual_events, typhon_watch_senders:virtual_events).
old(typhon_whereabouts:news_seconds, typhon_news:news_seconds).

:- begin_tests(old_settings).

test(old_name_sets_the_new_one,
     [ forall(old(Old, New)),
       Value-Messages == Other-[warning-typhon(setting_renamed(Old, New))] ]) :-
    setting_property(New, default(Default)),
    setting_property(New, type(Type)),
    other(Type, Default, Other),
    call_cleanup(
        ( capturing(set_setting(Old, Other), Messages),
          setting(New, Value) ),
        capturing(restore_setting(Old), _)).
test(value_of_an_old_name_is_checked, error(type_error(_, many))) :-
    set_setting(typhon_keeper:resting, many).
test(old_names_are_not_listed, Old == []) :-
    findall(Name, ( current_setting(Name),
                    old(Name, _) ), Old).

:- end_tests(old_settings).

other(boolean, Default, Other) :-
    !,
    ( Default == true -> Other = false ; Other = true ).
other(_, Default, Other) :-
    integer(Default),
    !,
    Other is Default+1.
other(_, Default, Other) :-
    float(Default),
    !,
    Other is Default/2.
other(_, _, other).
