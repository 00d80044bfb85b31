:- module(typhon_index,
          [ part_joins/3,               % ?Seam, ?What, ?Part
            part_file/2,                % ?Part, ?File
            part_setting/6              % ?Name, ?Module, ?Type, ?Default, ?Text,
                                        % ?File
          ]).

/** <module> What is loaded on demand

Made by `swipl doc/layers.pl -- index`, and compared by `make check`.

*Threading*: facts.
*/

%!  part_joins(?Seam, ?What, ?Part) is nondet.
%
%   Part defines the hook Seam for What.

part_joins(carries,step,'options/trace').
part_joins(carries,trace,'options/trace').
part_joins(check_option,policy,'options/guard').
part_joins(durable,agent,'options/journal').
part_joins(durable,birth,'options/identity').
part_joins(durable,letter,'options/journal').
part_joins(durable,logged,'options/journal').
part_joins(durable,monitor,'options/supervision').
part_joins(durable,offer,'options/directory').
part_joins(durable,order,'options/snapshot').
part_joins(durable,out,'options/journal').
part_joins(durable,program,'options/snapshot').
part_joins(durable,seen,'options/journal').
part_joins(durable,stands,'options/snapshot').
part_joins(durable,state,'options/journal').
part_joins(durable,stays,'options/snapshot').
part_joins(durable,tuple,'options/journal').
part_joins(durable,turns,'options/concurrency').
part_joins(environment,'TYPHON_TLS','options/tls').
part_joins(fault,location,'tools/source_view').
part_joins(host_option,audit,'options/access').
part_joins(host_option,authors,'options/identity').
part_joins(host_option,cell,'options/cell').
part_joins(host_option,clock,'options/virtual').
part_joins(host_option,concurrency,'options/concurrency').
part_joins(host_option,journal,'options/journal').
part_joins(host_option,log,'options/host_log').
part_joins(host_option,peer,'options/access').
part_joins(host_option,policy,'options/guard').
part_joins(host_option,quota,'options/quotas').
part_joins(host_option,sync,'options/journal').
part_joins(host_option,tls,'options/tls').
part_joins(host_option,trail,'options/trail').
part_joins(keys,any,'options/identity').
part_joins(keys,any,'options/trail').
part_joins(link_option,cost,'tools/administration').
part_joins(load_option,host,'tools/administration').
part_joins(machine_option,advertise,network).
part_joins(machine_option,bind,network).
part_joins(machine_option,node,network).
part_joins(machine_option,swipl,network).
part_joins(network_load_option,log,network).
part_joins(order,attach,'options/identity').
part_joins(order,change,'tools/administration').
part_joins(order,image,'tools/administration').
part_joins(order,watched,'options/trace').
part_joins(pheromone_option,period,'options/migration').
part_joins(pheromone_option,span,'options/migration').
part_joins(pheromone_option,strength,'options/migration').
part_joins(program,read,'tools/checks').
part_joins(question,mailbox,'tools/administration').
part_joins(question,program,'tools/administration').
part_joins(question,properties,'tools/administration').
part_joins(question,step,'options/trace').
part_joins(question,trail,'options/trail').
part_joins(received,channel,'options/journal').
part_joins(received,log,network).
part_joins(received,message,'options/external_recipients').
part_joins(received,pheromone,'options/migration').
part_joins(recipient,external,'options/external_recipients').
part_joins(requested,close_up,tools).
part_joins(requested,directory,'options/directory').
part_joins(requested,everywhere,'options/watch').
part_joins(requested,hosting,'tools/administration').
part_joins(requested,log,network).
part_joins(requested,monitor,'options/supervision').
part_joins(requested,node,network).
part_joins(requested,survey,tools).
part_joins(requested,trace,'options/trace').
part_joins(requested,watch,'options/watch').
part_joins(requested,watched,'options/watch').
part_joins(ros_call_option,deadline,'bridges/ros').
part_joins(spied,program,'options/trace').
part_joins(time,single,'options/single').
part_joins(time,virtual,'options/virtual').
part_joins(untrusted,any,'options/cell').
part_joins(untrusted,any,'options/quotas').

%!  part_file(?Part, ?File) is nondet.
%
%   File, below prolog/typhon, defines hooks of Part.

part_file('bridges/ros','bridges/ros/events').
part_file('bridges/ros','bridges/ros/requests').
part_file('bridges/ros','bridges/ros/service').
part_file(network,'network/changes').
part_file(network,'network/children').
part_file(network,'network/dynamics').
part_file(network,'network/loading').
part_file(network,'network/log').
part_file(network,'network/networks').
part_file(network,'network/node_process').
part_file(network,'network/plan').
part_file(network,'network/topology').
part_file(network,'network/wiring').
part_file('options/access','options/access').
part_file('options/cell','options/cell/cell_hosts').
part_file('options/cell','options/cell/gatekeeper').
part_file('options/concurrency','options/concurrency').
part_file('options/directory','options/directory/offers').
part_file('options/external_recipients','options/external_recipients').
part_file('options/guard','options/guard').
part_file('options/host_log','options/host_log').
part_file('options/identity','options/identity/authors').
part_file('options/identity','options/identity/birth').
part_file('options/identity','options/identity/sender_rights').
part_file('options/journal','options/journal/channel').
part_file('options/journal','options/journal/committing').
part_file('options/journal','options/journal/hop_ids').
part_file('options/journal','options/journal/journaled_agents').
part_file('options/journal','options/journal/journaled_tuples').
part_file('options/journal','options/journal/postgresql').
part_file('options/journal','options/journal/recovery').
part_file('options/journal','options/journal/store').
part_file('options/journal','options/journal/units_of_work').
part_file('options/migration','options/migration/pheromone').
part_file('options/migration','options/migration/strategy').
part_file('options/quotas','options/quotas').
part_file('options/quotas','options/quotas/quota_agents').
part_file('options/quotas','options/quotas/quota_enforcer').
part_file('options/quotas','options/quotas/quota_table').
part_file('options/quotas','options/quotas/usage').
part_file('options/single','options/single').
part_file('options/snapshot','options/snapshot').
part_file('options/supervision','options/supervision/failed_processes').
part_file('options/supervision','options/supervision/monitored_agents').
part_file('options/supervision','options/supervision/monitors').
part_file('options/supervision','options/supervision/relations').
part_file('options/tls','options/tls/secure').
part_file('options/trace','options/trace/spying').
part_file('options/trace','options/trace/stepping').
part_file('options/trace','options/trace/tracing').
part_file('options/trail','options/trail/trail').
part_file('options/trail','options/trail/trail_verified').
part_file('options/virtual','options/virtual').
part_file('options/watch','options/watch/metrics').
part_file('options/watch','options/watch/watch_receiver').
part_file('options/watch','options/watch/watch_senders').
part_file('options/watch','options/watch/watched_hosts').
part_file(tools,'tools/inventory').
part_file('tools/administration','tools/administration/change').
part_file('tools/administration','tools/administration/host_questions').
part_file('tools/administration','tools/administration/properties').
part_file('tools/administration','tools/administration/restore').
part_file('tools/checks','tools/checks/goal_lines').
part_file('tools/checks','tools/checks/warnings').
part_file('tools/source_view','tools/source_view/clause_location').

%!  part_setting(?Name, ?Module, ?Type, ?Default, ?Text, ?File) is nondet.
%
%   File declares the setting Module:Name.

part_setting(again_seconds,typhon_monitors,number,1,'Seconds until a lost request to the home of an agent is repeated','options/supervision/monitors').
part_setting(answer_seconds,typhon_processes,number,2,'Seconds of silence after which a stopping process is killed','network/processes').
part_setting(atom_chars,typhon_guard_limits,positive_integer,1000,'Atoms that untrusted agents make have at most so many characters','options/guard/guard_limits').
part_setting(ball_cells,typhon_guard_calls,positive_integer,10000,'Parts of a term that an untrusted agent throws, at most','options/guard/guard_calls').
part_setting(births,typhon_birth,positive_integer,20000,'Agents whose proofs of ownership are kept','options/identity/birth').
part_setting(browsers,typhon_page_browsers,positive_integer,32,'Browsers that may be connected to a page at a time','tools/page/browsers').
part_setting(cells,typhon_cells,positive_integer,16,'Processes for agents of untrusted owners, at most','options/cell/cells').
part_setting(cells,typhon_offers,positive_integer,1000,'Cells of an offer, at most; eight characters of a text count as one','options/directory/offers').
part_setting(cells,typhon_pheromone,positive_integer,1000,'Cells of the problem of a pheromone, at most; eight characters of a text count as one','options/migration/pheromone').
part_setting(certificates,typhon_keys,positive_integer,256,'Certificates whose holder is cached','options/keys').
part_setting(channel_seconds,typhon_channel,number,300,'Seconds for which posts are kept for a process that has left, and is not known to keep a journal','options/journal/channel').
part_setting(clause_cells,typhon_guard_limits,positive_integer,200000,'Clauses that untrusted agents add have at most so many parts','options/guard/guard_limits').
part_setting(connections,typhon_page_reception,positive_integer,64,'Clients of a page at a time','tools/page/server').
part_setting(content_characters,typhon_host_log,positive_integer,200,'The text of longer messages is cut to this many characters','options/host_log').
part_setting(delay,typhon_event_sender,number,0.05,'Seconds for which events gather before they are sent','options/watch/event_sender').
part_setting(entries,typhon_fipa_managers,positive_integer,10000,'Descriptions in a directory of FIPA','bridges/fipa/managers').
part_setting(events,typhon_watch_senders,positive_integer,10000,'Events that may wait for a slow watch','options/watch/watch_senders').
part_setting(frame_events,typhon_page_browsers,positive_integer,2000,'Events in a text that a page sends','tools/page/browsers').
part_setting(frame_seconds,typhon_page_browsers,number,0.05,'Seconds between two texts with events that a page sends','tools/page/browsers').
part_setting(functors,typhon_cells,positive_integer,20000,'Functors that the cells of an owner may bring into the process','options/cell/cell_functors').
part_setting(head_bytes,typhon_page_reception,positive_integer,16384,'Bytes of the head of a request, at most','tools/page/server').
part_setting(heartbeat_seconds,typhon_page_browsers,number,5,'Seconds without events after which a page sends a heartbeat','tools/page/browsers').
part_setting(hold_seconds,typhon_saving,number,30,'Seconds for a network to come to rest before it is saved','network/saving').
part_setting(idle,typhon_cells,number,60,'Seconds after which a cell that no agent uses ends','options/cell/cells').
part_setting(kill_seconds,typhon_processes,number,10,'Seconds for a killed process to end','network/processes').
part_setting(last_seconds,typhon_watches,number,2,'Seconds that unwatch/1 waits for earlier events','options/watch/watch_receiver').
part_setting(links,typhon_trail,positive_integer,32,'Links that are kept of the trail of an agent','options/trail/trail').
part_setting(longest,typhon_ros_rosbridge,nonneg,4000000,'Characters of one message from a rosbridge server','bridges/ros/rosbridge').
part_setting(memory,typhon_cells,positive_integer,1500000000,'Bytes of address space that a cell may have','options/cell/cell_process').
part_setting(met,typhon_fipa_platform,positive_integer,10000,'Agents of other platforms whose addresses are remembered','bridges/fipa/platform').
part_setting(most,typhon_ros_advertisements,positive_integer,1000,'Topics and services that a host may use, each in its way','bridges/ros/advertisements').
part_setting(most,typhon_ros_requests,positive_integer,1000,'Requests of ROS that may wait for the answers of agents','bridges/ros/requests').
part_setting(offers,typhon_offers,positive_integer,100,'Offers of an agent','options/directory/offers').
part_setting(order_seconds,typhon_processes,number,60,'Seconds for a process to answer an order','network/nodes').
part_setting(patience,typhon_event_sender,number,30,'Seconds that a disconnected watching process has to answer','options/watch/event_sender').
part_setting(patience,typhon_virtual,number,10,'Virtual time that stands still for so long is reported','options/virtual').
part_setting(pause,typhon_quota_enforcer,between(0.0,1.0),0.8,'Agents that run for long where there are quotas pause for this part of the time while others run','options/quotas/quota_enforcer').
part_setting(pheromones,typhon_pheromone,positive_integer,1000,'Pheromones that a host has at most','options/migration/pheromone').
part_setting(python,typhon_helper_process,atom,'','The Python of helpers; \'\' for that of the system','bridges/helper/process').
part_setting(python,typhon_nxt_link,atom,'','The Python of the helpers of bricks; \'\' for that of all helpers','bridges/nxt/link').
part_setting(queue,typhon_subscribers,positive_integer,1000,'Messages of bridges that may wait for an agent','bridges/common/subscribers').
part_setting(renew_seconds,typhon_page_sources,number,3,'Seconds between searches of a page for new hosts','tools/page/sources').
part_setting(request_bytes,typhon_page_server,positive_integer,4000000,'Bytes of a request to a page, at most','tools/page/server').
part_setting(request_seconds,typhon_page_reception,positive_integer,20,'Seconds for the head of a request, and for its body','tools/page/server').
part_setting(rest_seconds,typhon_node_process,number,1,'Seconds for agents to come to rest when their network stops','network/node_process').
part_setting(restart_seconds,typhon_restarts,number,60,'Seconds within which the setting restarts counts','network/restarts').
part_setting(restarts,typhon_restarts,nonneg,10,'Restarts of a process within restart_seconds','network/restarts').
part_setting(seconds,typhon_inventory,number,2,'Seconds for which a table waits for other processes of a network','tools/inventory').
part_setting(silent_seconds,typhon_postgresql,positive_integer,10,'Seconds without data after which the machine of a database server is taken to be gone','options/journal/postgresql').
part_setting(ssh,typhon_children,atom,ssh,'The program that reaches other machines','network/children').
part_setting(start,typhon_cells,number,120,'Seconds in which a cell has to load its program','options/cell/cell_process').
part_setting(start_seconds,typhon_processes,number,60,'Seconds for the processes of a network to start','network/processes').
part_setting(stop_seconds,typhon_children,number,5,'Seconds for a child to end in order before it is killed','network/children').
part_setting(traced,typhon_tracing,positive_integer,1000,'Agents whose traces are printed, the latest','options/trace/tracing').
part_setting(virtual_events,typhon_watch_senders,positive_integer,1000000,'The same in virtual time, which runs ahead of all watches','options/watch/watch_senders').
part_setting(watches,typhon_watch_senders,positive_integer,100,'Watches that another process may have here','options/watch/watch_senders').
