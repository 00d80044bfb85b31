:- module(typhon_old_settings, []).
:- use_module(library(broadcast), [listen/2]).
:- use_module(library(settings), [set_setting/2]).

/** <module> Settings that have been renamed

A program that sets the old name of a setting sets the new one, and is warned.
Old names are not listed.

*Threading*: any thread.
*/

:- multifile
    prolog:message//1,
    settings:current_setting/6.

settings:current_setting(Name, Module, Type, Default, Comment, Source) :-
    atom(Module),
    atom(Name),
    renamed(Module:Name, NewModule:NewName),
    settings:current_setting(NewName, NewModule, Type, Default, Comment,
                             Source).

:- listen(settings(changed(Old, _, Value)), setting_changed(Old, Value)).

setting_changed(Old, Value) :-
    renamed(Old, New),
    print_message(warning, typhon(setting_renamed(Old, New))),
    set_setting(New, Value).

prolog:message(typhon(setting_renamed(Old, New))) -->
    [ 'The setting ~w has been renamed; set ~w'-[Old, New] ].

%   renamed(?Old, ?New)

renamed(typhon_acceptor:strangers, typhon_acceptor:unproved).
renamed(typhon_auth:handshake_time, typhon_handshake:handshake_time).
renamed(typhon_base_key_files:certificates, typhon_keys:certificates).
renamed(typhon_carrier:rest_seconds, typhon_node_process:rest_seconds).
renamed(typhon_carriers:kill_seconds, typhon_processes:kill_seconds).
renamed(typhon_carriers:order_seconds, typhon_processes:order_seconds).
renamed(typhon_carriers:start_seconds, typhon_processes:start_seconds).
renamed(typhon_contacts:contacts, typhon_peer_cache:contacts).
renamed(typhon_doubt:settle_seconds, typhon_in_doubt:settle_seconds).
renamed(typhon_event_shown:content_characters,
        typhon_host_log:content_characters).
renamed(typhon_fipa_directory:entries, typhon_fipa_managers:entries).
renamed(typhon_guard_arguments:ball_cells, typhon_guard_calls:ball_cells).
renamed(typhon_guard_texts:atom_chars, typhon_guard_limits:atom_chars).
renamed(typhon_held:held_seconds, typhon_scheduler:blocked_seconds).
renamed(typhon_held:held_workers, typhon_scheduler:blocked_workers).
renamed(typhon_hello:records, typhon_handshake:records).
renamed(typhon_helper_python:python, typhon_helper_process:python).
renamed(typhon_hop:doubt_seconds, typhon_in_doubt:shown_seconds).
renamed(typhon_hop:settle_seconds, typhon_in_doubt:settle_seconds).
renamed(typhon_keeper:connect_time, typhon_connection_manager:connect_time).
renamed(typhon_keeper:resting, typhon_connection_manager:resting).
renamed(typhon_keeper:return_time, typhon_connection_manager:return_time).
renamed(typhon_legacies:clones, typhon_outcomes:clones).
renamed(typhon_legacies:legacies, typhon_outcomes:results).
renamed(typhon_legacy:result_bytes, typhon_payloads:result_bytes).
renamed(typhon_life:faulty, typhon_creation:faulty).
renamed(typhon_named:met, typhon_questions:met).
renamed(typhon_nxt_helper:python, typhon_nxt_link:python).
renamed(typhon_overuse:pause, typhon_quota_enforcer:pause).
renamed(typhon_refusing:clause_cells, typhon_guard_limits:clause_cells).
renamed(typhon_ros_open_requests:most, typhon_ros_requests:most).
renamed(typhon_ros_socket:longest, typhon_ros_rosbridge:longest).
renamed(typhon_ros_standing:most, typhon_ros_advertisements:most).
renamed(typhon_survey:seconds, typhon_inventory:seconds).
renamed(typhon_telling:delay, typhon_event_sender:delay).
renamed(typhon_telling:events, typhon_watch_senders:events).
renamed(typhon_telling:patience, typhon_event_sender:patience).
renamed(typhon_telling:virtual_events, typhon_watch_senders:virtual_events).
renamed(typhon_whereabouts:news_seconds, typhon_news:news_seconds).
