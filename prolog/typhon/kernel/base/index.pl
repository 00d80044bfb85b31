:- module(typhon_index,
          [ part_joins/3,               % ?Seam, ?What, ?Part
            part_file/2,                % ?Part, ?File
            part_setting/6              % ?Name, ?Module, ?Type, ?Default, ?Text,
                                        % ?File
          ]).
:- use_module(library(lists), [member/2]).

/** <module> What is loaded on demand

Made by `swipl doc/layers.pl -- index`, and compared by `make check`.

*Threading*: facts.
*/

%!  part_joins(?Seam, ?What, ?Part) is nondet.
%
%   Part defines the hook Seam for What.

part_joins(Seam, What, Part) :-
    joins(Seam, Part, Whats),
    member(What, Whats).

joins(carries,'options/trace',[step,trace]).
joins(check_option,'options/guard',[policy]).
joins(description,'options/fleet',[any]).
joins(durable,'options/concurrency',[turns]).
joins(durable,'options/directory',[offer]).
joins(durable,'options/fleet',[fleet_letter]).
joins(durable,'options/identity',[birth]).
joins(durable,'options/journal',[agent,asked,letter,logged,out,seen,state,tuple]).
joins(durable,'options/people',[invitation,question]).
joins(durable,'options/snapshot',[order,program,stands,stays]).
joins(durable,'options/supervision',[monitor]).
joins(environment,'options/tls',['TYPHON_TLS']).
joins(fault,'language/faults',[report]).
joins(fault,'tools/source_view',[location]).
joins(fleet,'options/fleet',[joined]).
joins(host_option,'options/access',[audit,peer]).
joins(host_option,'options/cell',[cell]).
joins(host_option,'options/concurrency',[concurrency]).
joins(host_option,'options/fleet',[fleet,tags]).
joins(host_option,'options/guard',[policy]).
joins(host_option,'options/host_log',[log]).
joins(host_option,'options/identity',[authors]).
joins(host_option,'options/journal',[journal,sync]).
joins(host_option,'options/people',[people]).
joins(host_option,'options/quotas',[quota]).
joins(host_option,'options/tls',[tls]).
joins(host_option,'options/trail',[trail]).
joins(host_option,'options/virtual',[away,clock]).
joins(journal,'options/fleet',[redis]).
joins(journal,'options/journal',[postgresql,text]).
joins(keys,'options/identity',[any]).
joins(keys,'options/trail',[any]).
joins(link_option,'tools/administration',[cost]).
joins(load_option,'tools/administration',[host]).
joins(machine_option,network,[advertise,bind,more,node,swipl]).
joins(network_load_option,network,[log]).
joins(order,'options/identity',[attach]).
joins(order,'options/trace',[watched]).
joins(order,'tools/administration',[change,image]).
joins(payload,'options/payloads',[any]).
joins(pheromone_option,'options/migration',[period,span,strength]).
joins(program,language,[text]).
joins(program,'language/chunks',[runs]).
joins(program,'tools/checks',[read]).
joins(question,'options/trace',[step]).
joins(question,'options/trail',[trail]).
joins(question,'tools/administration',[mailbox,program,properties]).
joins(received,network,[log]).
joins(received,'options/external_recipients',[message]).
joins(received,'options/journal',[channel]).
joins(received,'options/migration',[pheromone]).
joins(recipient,'options/external_recipients',[external]).
joins(requested,network,[log,node]).
joins(requested,'options/directory',[directory]).
joins(requested,'options/remote',[remote]).
joins(requested,'options/supervision',[monitor]).
joins(requested,'options/trace',[trace]).
joins(requested,'options/watch',[everywhere,watch,watched]).
joins(requested,tools,[close_up,survey]).
joins(requested,'tools/administration',[hosting]).
joins(ros_call_option,'bridges/ros',[deadline]).
joins(slurm_option,network,[more,node,nodes,partition,swipl,time]).
joins(spied,'options/trace',[program]).
joins(time,'options/single',[single]).
joins(time,'options/virtual',[virtual]).
joins(untrusted,'options/cell',[any]).
joins(untrusted,'options/quotas',[any]).

%!  part_file(?Part, ?File) is nondet.
%
%   File, below prolog/typhon, defines hooks of Part.

part_file(Part, File) :-
    files(Part, Files),
    member(File, Files).

files('bridges/ros',['bridges/ros/events','bridges/ros/requests','bridges/ros/service']).
files(language,['language/programs','language/source']).
files('language/chunks',['language/chunks/chunk_compiler']).
files('language/faults',['language/faults']).
files(network,['network/changes','network/dynamics','network/loading','network/log','network/machines','network/networks','network/node_process','network/plan','network/slurm','network/topology','network/wiring']).
files('options/access',['options/access']).
files('options/cell',['options/cell/cell_hosts','options/cell/gatekeeper']).
files('options/concurrency',['options/concurrency']).
files('options/directory',['options/directory/offers']).
files('options/external_recipients',['options/external_recipients']).
files('options/fleet',['options/fleet/drain','options/fleet/fleet_journal','options/fleet/members','options/fleet/modelled_members','options/fleet/parking','options/fleet/registry','options/fleet/tags','options/fleet/takeover']).
files('options/guard',['options/guard']).
files('options/host_log',['options/host_log']).
files('options/identity',['options/identity/authors','options/identity/birth','options/identity/sender_rights']).
files('options/journal',['options/journal/channel','options/journal/committing','options/journal/hop_ids','options/journal/journaled_agents','options/journal/journaled_tuples','options/journal/recovery','options/journal/sql_tables','options/journal/store','options/journal/units_of_work']).
files('options/migration',['options/migration/pheromone','options/migration/strategy']).
files('options/payloads',['options/payloads']).
files('options/people',['options/people','options/people/person_questions']).
files('options/quotas',['options/quotas','options/quotas/quota_agents','options/quotas/quota_enforcer','options/quotas/quota_table','options/quotas/usage']).
files('options/remote',['options/remote']).
files('options/single',['options/single']).
files('options/snapshot',['options/snapshot']).
files('options/supervision',['options/supervision/failed_processes','options/supervision/monitored_agents','options/supervision/monitors','options/supervision/relations']).
files('options/tls',['options/tls/secure']).
files('options/trace',['options/trace/spying','options/trace/stepping','options/trace/tracing']).
files('options/trail',['options/trail/trail','options/trail/trail_verified']).
files('options/virtual',['options/virtual','options/virtual/away']).
files('options/watch',['options/watch/metrics','options/watch/watch_receiver','options/watch/watch_senders','options/watch/watched_hosts']).
files(tools,['tools/inventory']).
files('tools/administration',['tools/administration/change','tools/administration/host_questions','tools/administration/properties','tools/administration/restore']).
files('tools/checks',['tools/checks/goal_lines','tools/checks/warnings']).
files('tools/source_view',['tools/source_view/clause_location']).

%!  part_setting(?Name, ?Module, ?Type, ?Default, ?Text, ?File) is nondet.
%
%   File declares the setting Module:Name.

part_setting(again_seconds,typhon_monitors,number,1,'Seconds until a lost request to the home of an agent is repeated','options/supervision/monitors').
part_setting(answer_bytes,typhon_people_server,positive_integer,20000,'Bytes of a request of a person, at most','tools/page/people_server').
part_setting(answer_seconds,typhon_processes,number,2,'Seconds of silence after which a stopping process is killed','network/processes').
part_setting(atom_chars,typhon_guard_limits,positive_integer,1000,'Atoms that untrusted agents make have at most so many characters','options/guard/guard_limits').
part_setting(ball_cells,typhon_guard_calls,positive_integer,10000,'Parts of a term that an untrusted agent throws, at most','options/guard/guard_calls').
part_setting(births,typhon_birth,positive_integer,20000,'Agents whose proofs of ownership are kept','options/identity/birth').
part_setting(browsers,typhon_page_browsers,positive_integer,32,'Browsers that may be connected to a page at a time','tools/page/browsers').
part_setting(cells,typhon_cells,positive_integer,16,'Processes for agents of untrusted owners, at most','options/cell/cells').
part_setting(cells,typhon_offers,positive_integer,1000,'Cells of an offer, at most; eight characters of a text count as one','options/directory/offers').
part_setting(cells,typhon_person_words,positive_integer,2000,'Cells of a question with its choices, at most; eight characters of a text count as one','options/people/person_words').
part_setting(cells,typhon_pheromone,positive_integer,1000,'Cells of the problem of a pheromone, at most; eight characters of a text count as one','options/migration/pheromone').
part_setting(certificates,typhon_keys,positive_integer,256,'Certificates whose holder is cached','options/keys').
part_setting(channel_seconds,typhon_channel,number,300,'Seconds for which posts are kept for a process that has left, and is not known to keep a journal','options/journal/channel').
part_setting(characters,typhon_person_questions,positive_integer,2000,'Characters of the answer of a person, at most','options/people/person_questions').
part_setting(choice_seconds,typhon_fleet,number,0.5,'Seconds for which a list of hosts serves for choices by any(Tag)','options/fleet/tags').
part_setting(clause_cells,typhon_guard_limits,positive_integer,200000,'Clauses that untrusted agents add have at most so many parts','options/guard/guard_limits').
part_setting(connections,typhon_page_reception,positive_integer,64,'Clients of a page at a time','tools/page/reception').
part_setting(connections,typhon_people_server,positive_integer,256,'Clients of the page for people at a time','tools/page/people_server').
part_setting(content_characters,typhon_host_log,positive_integer,200,'The text of longer messages is cut to this many characters','options/host_log').
part_setting(delay,typhon_event_sender,number,0.05,'Seconds for which events gather before they are sent','options/watch/event_sender').
part_setting(engine_pause,typhon_fleet,number,0.5,'Seconds for which an engine that is down is not asked again','options/fleet/engine').
part_setting(engine_seconds,typhon_fleet,number,2,'Seconds after which an engine that does not answer counts as down','options/fleet/engine').
part_setting(entries,typhon_fipa_managers,positive_integer,10000,'Descriptions in a directory of FIPA','bridges/fipa/managers').
part_setting(events,typhon_watch_senders,positive_integer,10000,'Events that may wait for a slow watch','options/watch/watch_senders').
part_setting(fenced_exit,typhon_fleet,boolean,true,'A process without a terminal ends when another one has its address or its journal','options/fleet/takeover').
part_setting(files,typhon_loaded,nonneg,64,'Programs remembered as they were read','language/programs').
part_setting(frame_events,typhon_page_browsers,positive_integer,2000,'Events in a text that a page sends','tools/page/browsers').
part_setting(frame_seconds,typhon_page_browsers,number,0.05,'Seconds between two texts with events that a page sends','tools/page/browsers').
part_setting(functors,typhon_cells,positive_integer,20000,'Functors that the cells of an owner may bring into the process','options/cell/cell_functors').
part_setting(head_bytes,typhon_page_reception,positive_integer,16384,'Bytes of the head of a request, at most','tools/page/reception').
part_setting(heartbeat_seconds,typhon_page_browsers,number,5,'Seconds without events after which a page sends a heartbeat','tools/page/browsers').
part_setting(hold_seconds,typhon_saving,number,30,'Seconds for a network to come to rest before it is saved','network/saving').
part_setting(idle,typhon_cells,number,60,'Seconds after which a cell that no agent uses ends','options/cell/cells').
part_setting(kill_seconds,typhon_processes,number,10,'Seconds for a killed process to end','network/processes').
part_setting(last_seconds,typhon_watches,number,2,'Seconds that unwatch/1 waits for earlier events','options/watch/watch_receiver').
part_setting(letters,typhon_fleet,positive_integer,10000,'Letters that wait here until the engine answers','options/fleet/parking').
part_setting(links,typhon_trail,positive_integer,32,'Links that are kept of the trail of an agent','options/trail/trail').
part_setting(longest,typhon_ros_rosbridge,nonneg,4000000,'Characters of one message from a rosbridge server','bridges/ros/rosbridge').
part_setting(memory,typhon_cells,positive_integer,1500000000,'Bytes of address space that a cell may have','options/cell/cell_process').
part_setting(met,typhon_fipa_platform,positive_integer,10000,'Agents of other platforms whose addresses are remembered','bridges/fipa/platform').
part_setting(most,typhon_ros_advertisements,positive_integer,1000,'Topics and services that a host may use, each in its way','bridges/ros/advertisements').
part_setting(most,typhon_ros_requests,positive_integer,1000,'Requests of ROS that may wait for the answers of agents','bridges/ros/requests').
part_setting(offers,typhon_offers,positive_integer,100,'Offers of an agent','options/directory/offers').
part_setting(order_seconds,typhon_processes,number,60,'Seconds for a process to answer an order','network/nodes').
part_setting(outcome_length,typhon_fleet,positive_integer,20000,'Characters of an outcome with its results; longer ones are kept without results','options/fleet/registry').
part_setting(outcomes,typhon_fleet,positive_integer,20000,'Ends of agents that a fleet keeps for each home, and a process until its fleet has them','options/fleet/registry').
part_setting(parcel_bytes,typhon_fleet,positive_integer,16777216,'The longest agent or letter that is parked, as text','options/fleet/parking').
part_setting(parked_bytes,typhon_fleet,positive_integer,268435456,'Bytes that are parked for a process','options/fleet/parking').
part_setting(parked_items,typhon_fleet,positive_integer,10000,'Agents and letters that are parked for a process','options/fleet/parking').
part_setting(patience,typhon_event_sender,number,30,'Seconds that a disconnected watching process has to answer','options/watch/event_sender').
part_setting(patience,typhon_virtual,number,10,'Virtual time that stands still for so long is reported','options/virtual').
part_setting(pause,typhon_quota_enforcer,between(0.0,1.0),0.8,'Agents that run for long where there are quotas pause for this part of the time while others run','options/quotas/quota_enforcer').
part_setting(pheromones,typhon_pheromone,positive_integer,1000,'Pheromones that a host has at most','options/migration/pheromone').
part_setting(python,typhon_helper_process,atom,'','The Python of helpers; \'\' for that of the system','bridges/helper/process').
part_setting(python,typhon_nxt_link,atom,'','The Python of the helpers of bricks; \'\' for that of all helpers','bridges/nxt/link').
part_setting(questions,typhon_person_questions,positive_integer,200,'Questions that wait for a person, at most','options/people/person_questions').
part_setting(queue,typhon_subscribers,positive_integer,1000,'Messages of bridges that may wait for an agent','bridges/common/subscribers').
part_setting(renew_seconds,typhon_page_sources,number,3,'Seconds between searches of a page for new hosts','tools/page/sources').
part_setting(request_bytes,typhon_page_server,positive_integer,4000000,'Bytes of a request to a page, at most','tools/page/server').
part_setting(request_seconds,typhon_page_reception,positive_integer,20,'Seconds for the head of a request, and for its body','tools/page/reception').
part_setting(rest_seconds,typhon_node_process,number,1,'Seconds for agents to come to rest when their network stops','network/node_process').
part_setting(restart_seconds,typhon_restarts,number,60,'Seconds within which the setting restarts counts','network/restarts').
part_setting(restarts,typhon_restarts,nonneg,10,'Restarts of a process within restart_seconds','network/restarts').
part_setting(seconds,typhon_inventory,number,2,'Seconds for which a table waits for other processes of a network','tools/inventory').
part_setting(silent_seconds,typhon_postgresql,positive_integer,10,'Seconds without data after which the machine of a database server is taken to be gone','options/journal/postgresql').
part_setting(ssh,typhon_children,atom,ssh,'The program that reaches other machines','network/machines').
part_setting(start,typhon_cells,number,120,'Seconds in which a cell has to load its program','options/cell/cell_process').
part_setting(start_seconds,typhon_processes,number,60,'Seconds for the processes of a network to start','network/processes').
part_setting(stop_seconds,typhon_children,number,5,'Seconds for a child to end in order before it is killed','network/children').
part_setting(sure_seconds,typhon_fleet,number,2,'Seconds until what an engine with fsync(everysec) has accepted counts as kept','options/fleet/parking').
part_setting(text_characters,typhon_people_server,positive_integer,2000,'Characters of a question that are shown; of a choice a tenth','tools/page/people_server').
part_setting(traced,typhon_tracing,positive_integer,1000,'Agents whose traces are printed, the latest','options/trace/tracing').
part_setting(virtual_events,typhon_watch_senders,positive_integer,1000000,'The same in virtual time, which runs ahead of all watches','options/watch/watch_senders').
part_setting(watches,typhon_watch_senders,positive_integer,100,'Watches that another process may have here','options/watch/watch_senders').
part_setting(work_seconds,typhon_fleet,number,5,'Seconds of silence after which work goes to another worker','options/fleet/work').
