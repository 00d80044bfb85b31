:- module(typhon_host, []).

/** <module> Hosts

A host is a module, its place, in which goals run for agents; it has a clock,
and a scheduler that gives threads to its agents.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(host/hosts,
            [ address_parts/3, host/3, host_address/2, host_admits/2,
              host_again/1, host_arrival/2, host_closed/1, host_enter/3,
              host_hop/4, host_hop_times/3, host_landing/4, host_uncount/1,
              host_departure/2, host_link/3, host_link_cost/3, host_load/2,
              host_moved/4, host_neighbours/2, host_note/1, host_option/2,
              host_passage/6, host_passes/2, host_plain_departure/2, host_put/2,
              host_resolve/2, host_unlink/2 ]).
:- reexport('host/events').
:- reexport(host/host_parts, [ amended/5, hosts_apart/2, parts/3, parts_call/3, parts_load/1 ]).
:- reexport(host/place,
            [ place_deliver/3, place_host/2, place_offer/2, place_serve/2,
              place_service/2, place_undeliver/2, tuple_leave/2, tuple_leave/3,
              tuple_leave_new/3, tuple_on/4, tuple_put/4, tuple_restored/4,
              tuple_sense/2, tuple_take/2 ]).
:- reexport(host/time,
            [ agents_run/1, alarm_in/3, alarm_set/3, clock/3, host_time/2,
              real_time/3, time_again/2, time_apart/2, time_due/3,
              time_hold/1, time_kind/1, time_leave/0, time_let_go/1,
              time_now/1, time_repeats/2, time_seed/1, time_signal/1,
              time_state/1, time_wait/3, time_wanted/2, time_work/1 ]).
:- reexport(host/scheduler,
            [ agent_parked/1, alarm_add/3, alarm_stamp/3, alarms_begin/0,
              alarms_end/0, alarms_go_off/1, index_delete/3, index_first/2,
              index_make/1, index_update/2, schedule/2, schedule_adopt/1,
              schedule_here/3, schedule_stays/2, scheduler_call/1,
              scheduler_limited/2, work_do/2 ]).
:- reexport(host/turns,
            [ context/3, context_agent/1, context_clear/0, context_host/1,
              context_now/2, context_set/3, in_context/2, turn_later/1,
              turn_of/3, turns_go_on/1, turns_now/3, turns_pause/0, turns_paused/0 ]).
:- reexport('host/runtime').
:- reexport('host/hosting').
:- reexport('host/rights').
