import jade.core.AID;
import jade.core.Agent;
import jade.core.Profile;
import jade.core.ProfileImpl;
import jade.core.behaviours.CyclicBehaviour;
import jade.core.behaviours.OneShotBehaviour;
import jade.domain.AMSService;
import jade.domain.DFService;
import jade.domain.FIPAException;
import jade.domain.FIPAAgentManagement.AMSAgentDescription;
import jade.domain.FIPAAgentManagement.DFAgentDescription;
import jade.domain.FIPAAgentManagement.Envelope;
import jade.domain.FIPAAgentManagement.SearchConstraints;
import jade.domain.FIPAAgentManagement.ServiceDescription;
import jade.lang.acl.ACLMessage;
import jade.lang.acl.MessageTemplate;
import jade.proto.AchieveREInitiator;
import jade.proto.ContractNetInitiator;
import jade.proto.ContractNetResponder;
import java.io.BufferedReader;
import java.io.InputStreamReader;
import java.util.Date;
import java.util.HashSet;
import java.util.Vector;

/*  A JADE platform that does what its standard input says, one command in a
    line, words separated by tabs, and prints what comes of it in one line
    each: `ok` or `error`, and words.

        java Peer MtpPort MainPort

    On it live `echo`, which answers requests by what they say, `bidder1` and
    `bidder2`, which take part in contract nets for 10 and for 7, and `driver`,
    which executes the commands.  */

public class Peer {
    static Agent driver;

    public static void main(String[] args) throws Exception {
        Profile profile = new ProfileImpl("127.0.0.1", Integer.parseInt(args[1]),
                                          "jadeplat");
        profile.setParameter(Profile.LOCAL_HOST, "127.0.0.1");
        profile.setParameter(Profile.MTPS,
            "jade.mtp.http.MessageTransportProtocol(http://127.0.0.1:"
            + args[0] + "/acc)");
        jade.wrapper.AgentContainer container =
            jade.core.Runtime.instance().createMainContainer(profile);
        Driver made = new Driver();
        container.acceptNewAgent("driver", made).start();
        container.acceptNewAgent("echo", new Echo()).start();
        container.acceptNewAgent("bidder1", new Bidder(10)).start();
        container.acceptNewAgent("bidder2", new Bidder(7)).start();
        BufferedReader in =
            new BufferedReader(new InputStreamReader(System.in, "UTF-8"));
        made.ready.await();
        System.out.println("ok\tready");
        String line;
        while ((line = in.readLine()) != null)
            made.obey(line.split("\t", -1));
        System.exit(0);
    }

    static AID foreign(String name, String url) {
        AID aid = new AID(name, AID.ISGUID);
        aid.addAddresses(url);
        return aid;
    }

    static void unicode(ACLMessage message) {
        Envelope envelope = new Envelope();
        envelope.setPayloadEncoding("UTF-8");
        message.setEnvelope(envelope);
    }

    static class Echo extends Agent {
        protected void setup() {
            DFAgentDescription description = new DFAgentDescription();
            description.setName(getAID());
            ServiceDescription service = new ServiceDescription();
            service.setType("echo");
            service.setName("echo of all kinds");
            description.addServices(service);
            try {
                DFService.register(this, description);
            } catch (FIPAException e) {
                e.printStackTrace();
            }
            addBehaviour(new CyclicBehaviour() {
                public void action() {
                    ACLMessage message = receive(
                        MessageTemplate.MatchPerformative(ACLMessage.REQUEST));
                    if (message == null) {
                        block();
                        return;
                    }
                    ACLMessage reply = message.createReply();
                    reply.setPerformative(ACLMessage.INFORM);
                    reply.setContent(message.getContent());
                    unicode(reply);
                    send(reply);
                }
            });
        }
    }

    static class Bidder extends Agent {
        final int price;

        Bidder(int price) {
            this.price = price;
        }

        protected void setup() {
            addBehaviour(new ContractNetResponder(this,
                    MessageTemplate.MatchPerformative(ACLMessage.CFP)) {
                protected ACLMessage handleCfp(ACLMessage cfp) {
                    ACLMessage reply = cfp.createReply();
                    reply.setPerformative(ACLMessage.PROPOSE);
                    reply.setContent("((price " + price + "))");
                    return reply;
                }

                protected ACLMessage handleAcceptProposal(ACLMessage cfp,
                        ACLMessage propose, ACLMessage accept) {
                    ACLMessage reply = accept.createReply();
                    reply.setPerformative(ACLMessage.INFORM);
                    reply.setContent("((done-for " + price + "))");
                    return reply;
                }
            });
        }
    }

    static class Driver extends Agent {
        final java.util.concurrent.CountDownLatch ready =
            new java.util.concurrent.CountDownLatch(1);

        protected void setup() {
            ready.countDown();
        }

        void tell(Object... words) {
            StringBuilder line = new StringBuilder();
            for (Object word : words)
                line.append(line.length() == 0 ? "" : "\t")
                    .append(String.valueOf(word).replace("\n", " "));
            synchronized (System.out) {
                System.out.println(line);
            }
        }

        void obey(final String[] words) {
            addBehaviour(new OneShotBehaviour() {
                public void action() {
                    try {
                        Driver.this.execute(words);
                    } catch (Exception e) {
                        tell("error", e.getMessage());
                    }
                }
            });
        }

        void execute(String[] words) throws Exception {
            switch (words[0]) {
                case "request": request(words); break;
                case "ask": ask(words); break;
                case "many": many(words); break;
                case "find": find(words); break;
                case "list": list(words); break;
                case "register": register(words); break;
                case "contract": contract(words); break;
                default: tell("error", "no command " + words[0]);
            }
        }

        /* request Name Url Content: by the request protocol */
        void request(String[] words) {
            ACLMessage message = new ACLMessage(ACLMessage.REQUEST);
            message.addReceiver(foreign(words[1], words[2]));
            message.setProtocol("fipa-request");
            message.setLanguage("fipa-sl");
            message.setContent(words[3]);
            message.setReplyByDate(
                new Date(System.currentTimeMillis() + 20000));
            unicode(message);
            addBehaviour(new AchieveREInitiator(this, message) {
                protected void handleInform(ACLMessage inform) {
                    tell("ok", "INFORM", inform.getContent());
                }

                protected void handleRefuse(ACLMessage refuse) {
                    tell("ok", "REFUSE", refuse.getContent());
                }

                protected void handleFailure(ACLMessage failure) {
                    tell("ok", "FAILURE", failure.getSender().getName(),
                         failure.getContent());
                }

                protected void handleNotUnderstood(ACLMessage answer) {
                    tell("ok", "NOT-UNDERSTOOD", answer.getContent());
                }
            });
        }

        ACLMessage answer(ACLMessage message, long milliseconds) {
            String id = "conversation " + System.nanoTime();
            message.setConversationId(id);
            message.setReplyWith("\"reply\" " + id);
            send(message);
            return blockingReceive(MessageTemplate.and(
                MessageTemplate.MatchConversationId(id),
                MessageTemplate.MatchInReplyTo("\"reply\" " + id)),
                milliseconds);
        }

        /* ask Performative Name Url Language Content: one message, one answer */
        void ask(String[] words) {
            ACLMessage message =
                new ACLMessage(ACLMessage.getInteger(words[1]));
            message.addReceiver(foreign(words[2], words[3]));
            message.setLanguage(words[4]);
            message.setContent(words[5]);
            unicode(message);
            ACLMessage got = answer(message, 20000);
            if (got == null)
                tell("error", "no answer");
            else
                tell("ok", ACLMessage.getPerformative(got.getPerformative()),
                     got.getSender().getName(), got.getContent());
        }

        /* many Name Url Count: conversations at once */
        void many(String[] words) {
            int count = Integer.parseInt(words[3]);
            HashSet<String> open = new HashSet<String>();
            long start = System.nanoTime();
            for (int i = 0; i < count; i++) {
                ACLMessage message = new ACLMessage(ACLMessage.REQUEST);
                message.addReceiver(foreign(words[1], words[2]));
                message.setContent("number " + i);
                message.setConversationId("many-" + i);
                message.setReplyWith("reply-" + i);
                open.add("many-" + i + "/reply-" + i + "/number " + i);
                send(message);
            }
            int wrong = 0;
            while (!open.isEmpty()) {
                ACLMessage got = blockingReceive(
                    MessageTemplate.not(
                        MessageTemplate.MatchConversationId("none")), 20000);
                if (got == null)
                    break;
                if (!open.remove(got.getConversationId() + "/"
                        + got.getInReplyTo() + "/" + got.getContent()))
                    wrong++;
            }
            long milliseconds = (System.nanoTime() - start) / 1000000;
            tell("ok", open.size(), wrong, milliseconds);
        }

        /* find Platform Url Type: agents with a service, from its DF */
        void find(String[] words) throws FIPAException {
            DFAgentDescription template = new DFAgentDescription();
            ServiceDescription service = new ServiceDescription();
            service.setType(words[3]);
            template.addServices(service);
            SearchConstraints constraints = new SearchConstraints();
            constraints.setMaxResults(Long.valueOf(-1));
            DFAgentDescription[] found = DFService.search(this,
                foreign("df@" + words[1], words[2]), template, constraints);
            Vector<Object> told = new Vector<Object>();
            told.add("ok");
            for (DFAgentDescription one : found) {
                told.add(one.getName().getName());
                told.add(one.getName().getAddressesArray()[0]);
            }
            tell(told.toArray());
        }

        /* list Platform Url: what its AMS knows */
        void list(String[] words) throws FIPAException {
            SearchConstraints constraints = new SearchConstraints();
            constraints.setMaxResults(Long.valueOf(-1));
            AMSAgentDescription[] found = AMSService.search(this,
                foreign("ams@" + words[1], words[2]),
                new AMSAgentDescription(), constraints);
            Vector<Object> told = new Vector<Object>();
            told.add("ok");
            for (AMSAgentDescription one : found)
                told.add(one.getName().getName());
            tell(told.toArray());
        }

        /* register Platform Url: the life of a description in its DF */
        void register(String[] words) throws FIPAException {
            AID df = foreign("df@" + words[1], words[2]);
            DFAgentDescription description = new DFAgentDescription();
            description.setName(getAID());
            ServiceDescription service = new ServiceDescription();
            service.setType("driving");
            service.setName("\"quick\" and \\ back");
            description.addServices(service);
            DFService.register(this, df, description);
            String twice = "registered twice";
            try {
                DFService.register(this, df, description);
            } catch (FIPAException e) {
                twice = e.getMessage();
            }
            service.setType("racing");
            DFService.modify(this, df, description);
            int racing = DFService.search(this, df, description,
                                          new SearchConstraints()).length;
            DFService.deregister(this, df);
            String gone = "deregistered twice";
            try {
                DFService.deregister(this, df);
            } catch (FIPAException e) {
                gone = e.getMessage();
            }
            tell("ok", twice, racing, gone);
        }

        /* contract Url Name1,Name2 Content: the best price gets it */
        void contract(String[] words) {
            ACLMessage cfp = new ACLMessage(ACLMessage.CFP);
            for (String name : words[2].split(","))
                cfp.addReceiver(foreign(name, words[1]));
            cfp.setProtocol("fipa-contract-net");
            cfp.setLanguage("fipa-sl");
            cfp.setContent(words[3]);
            cfp.setReplyByDate(new Date(System.currentTimeMillis() + 20000));
            addBehaviour(new ContractNetInitiator(this, cfp) {
                int refused = 0;

                int price(ACLMessage propose) {
                    return Integer.parseInt(
                        propose.getContent().replaceAll("[^0-9]", ""));
                }

                protected void handleRefuse(ACLMessage refuse) {
                    refused++;
                }

                protected void handleAllResponses(Vector responses,
                                                  Vector acceptances) {
                    ACLMessage best = null;
                    for (Object one : responses) {
                        ACLMessage propose = (ACLMessage) one;
                        if (propose.getPerformative() == ACLMessage.PROPOSE
                                && (best == null
                                    || price(propose) < price(best)))
                            best = propose;
                    }
                    for (Object one : responses) {
                        ACLMessage propose = (ACLMessage) one;
                        if (propose.getPerformative() != ACLMessage.PROPOSE)
                            continue;
                        ACLMessage reply = propose.createReply();
                        reply.setPerformative(propose == best
                            ? ACLMessage.ACCEPT_PROPOSAL
                            : ACLMessage.REJECT_PROPOSAL);
                        reply.setContent(propose.getContent());
                        acceptances.add(reply);
                    }
                    if (best == null)
                        tell("ok", "nobody", refused);
                }

                protected void handleInform(ACLMessage inform) {
                    tell("ok", inform.getSender().getName(),
                         inform.getContent(), refused);
                }

                protected void handleFailure(ACLMessage failure) {
                    tell("ok", "FAILURE", failure.getContent(), refused);
                }
            });
        }
    }
}
